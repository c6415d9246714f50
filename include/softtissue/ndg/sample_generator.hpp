// SPDX-License-Identifier: MIT
/// @file
/// Training data of neural deformation gradients: equilibria of one body in many poses.
///
/// What        SampleGenerator: for a pose, the bone wrap and the cuts by linear blend skinning, the flesh by LayeredFlesh,
///             started from Gradient Skinning. A sample that failed is a value that says why.
/// Units       x m, energies J
/// Tolerance   sample_options(): a Newton decrement of 3e-4 J, about 1e-5 of the energy of a posed body. In ordinary poses
///             solves from other starts then agree within some micrometres on average; soft wrinkles wander on below it.
/// Valid       any pose. Extreme ones have several equilibria: the start is always the same, so that the one that is found
///             is a function of body and pose.
/// Source      Nolte et al. 2026, sec. 3.2, 4.1
/// Cost        per body: patterns; per pose: see LayeredFlesh
/// Tests       tests/unit/ndg/sample_generator_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/metric/volume_change.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/ndg/shaped_body.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <string>

namespace softtissue {

/// What is computed, the same for all samples of a data set.
template <RealScalar S>
struct SampleOptions {
    FleshParameters<S> flesh = {};
    NewtonOptions<S> newton = quasi_static_options<S>();
};

/// The options of data sets.
template <RealScalar S>
SampleOptions<S> sample_options() {
    SampleOptions<S> options;
    options.newton.max_iterations = 60;
    options.newton.decrement_tolerance = S(3e-4);
    return options;
}

template <RealScalar S>
struct GeneratedSample {
    Matrix3X<S> positions;  // equilibrium, all vertices of the layers
    SolveReport<S> report;
    S rest_energy = S(0);
    Index num_inverted = 0;
    std::string failure;  // empty, or why the sample is not to be used

    bool succeeded() const { return failure.empty(); }
};

template <RealScalar S, NewtonLinearSolver LinearSolver = GaussSeidelCg<S>>
class SampleGenerator {
public:
    using Scalar = S;

    /// The body must outlive this.
    SampleGenerator(const ShapedBody<Scalar>& body, const KinematicTree& tree, const SampleOptions<Scalar>& options)
        : body_(&body),
          tree_(tree),
          options_(options),
          poisson_(body.layered.mesh, PrescribedVertices(body.layered.mesh.num_vertices(), body.layered.prescribed)),
          gradient_skinning_(poisson_, body.layered.mesh, body.layered.weights),
          flesh_(body.layered, options.flesh, executor_),
          rest_energy_(flesh_.energy(body.layered.mesh.rest_positions)) {}

    SampleGenerator(const SampleGenerator&) = delete;
    SampleGenerator& operator=(const SampleGenerator&) = delete;

    GeneratedSample<Scalar> generate(const Pose<Scalar>& pose) {
        const auto transforms = joint_transforms<Scalar>(tree_, body_->joints, pose);
        GeneratedSample<Scalar> sample;
        sample.rest_energy = rest_energy_;
        skin_points_into(LinearBlend<Scalar>(), transforms, body_->layered.weights, body_->layered.mesh.rest_positions,
                         prepared_joints_, sample.positions);
        gradient_skinning_.solve_into(bone_quaternions<Scalar>(transforms), sample.positions);
        sample.report = flesh_.solve_into(sample.positions, options_.newton);
        sample.num_inverted = volume_change(body_->layered.mesh, sample.positions).num_inverted;
        if (!sample.report.succeeded()) {
            sample.failure = std::string("no equilibrium: ") + to_string(sample.report.status);
        }
        return sample;
    }

private:
    const ShapedBody<Scalar>* body_;
    KinematicTree tree_;
    SampleOptions<Scalar> options_;
    SequentialExecutor executor_;
    PoissonReconstruction<Prism6, Scalar> poisson_;
    GradientSkinning<Prism6, Scalar> gradient_skinning_;
    LayeredFlesh<Scalar, SequentialExecutor, LinearSolver> flesh_;
    Scalar rest_energy_;
    MatrixX<Scalar> prepared_joints_;
};

}  // namespace softtissue
