// SPDX-License-Identifier: MIT
/// @file
/// A layered body in a pose, by the quasi-static reference or by one of the methods that avoid its cost.
///
/// What        pose_into(): positions of bone wrap, muscle wrap and skin for the joint transforms of a pose.
/// Methods     fem        LayeredFlesh, from Gradient Skinning
///             lbs, dqs   every vertex by its weights
///             gradient   Gradient Skinning: cells want the blended rotation of their bones
///             projective as rigid as possible, 30 rounds of local and global steps from Gradient Skinning
///             corotated  linear elasticity in the blended rotation of the bones
/// Boundary    the bone wrap and the cuts by linear blend skinning with the body's weights, the same for every method
/// Source      Nolte et al. 2026, sec. 3.2, 4.2, 4.3, 5.2
/// Tests       tests/unit/ndg/layered_animation_test.cpp, tests/scenario/layered_animation_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/solver/corotated_linear_solver.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/local_global.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <array>
#include <limits>
#include <span>
#include <vector>

namespace softtissue {

enum class AnimationMethod { fem, lbs, dqs, gradient, projective, corotated };

inline constexpr std::array all_animation_methods{AnimationMethod::fem,        AnimationMethod::lbs,
                                                  AnimationMethod::dqs,        AnimationMethod::gradient,
                                                  AnimationMethod::projective, AnimationMethod::corotated};

/// The method's name, as in the enumeration.
constexpr const char* to_string(AnimationMethod method) {
    switch (method) {
        case AnimationMethod::fem:
            return "fem";
        case AnimationMethod::lbs:
            return "lbs";
        case AnimationMethod::dqs:
            return "dqs";
        case AnimationMethod::gradient:
            return "gradient";
        case AnimationMethod::projective:
            return "projective";
        case AnimationMethod::corotated:
            return "corotated";
    }
    return "unknown";
}

template <RealScalar S, Executor ExecutorType, SparseCholesky<S> Cholesky = DefaultCholesky<S>,
          NewtonLinearSolver LinearSolver = GaussSeidelCg<S>>
class LayeredAnimation {
public:
    using Scalar = S;
    using Transforms = std::span<const AffineTransform<Scalar>>;

    /// Body and executor must outlive this.
    LayeredAnimation(const LayeredBody<Scalar>& body, const FleshParameters<Scalar>& parameters,
                     const ExecutorType& executor)
        : body_(&body),
          executor_(&executor),
          poisson_(body.mesh, PrescribedVertices(body.mesh.num_vertices(), body.prescribed)),
          gradient_skinning_(poisson_, body.mesh, body.weights),
          local_global_(poisson_),
          corotated_(body.mesh, poisson_.prescribed(), layer_moduli(body, parameters), executor),
          flesh_(body, parameters, executor) {}

    LayeredAnimation(const LayeredAnimation&) = delete;
    LayeredAnimation& operator=(const LayeredAnimation&) = delete;

    const LayeredBody<Scalar>& body() const { return *body_; }
    PoissonReconstruction<Prism6, Scalar>& poisson() { return poisson_; }
    LayeredFlesh<Scalar, ExecutorType, LinearSolver>& flesh() { return flesh_; }

    /// R_p of every cell, valid until the next call.
    const std::vector<Matrix3<Scalar>>& blended_rotations(Transforms joint_transforms) {
        return gradient_skinning_.rotations(bone_quaternions<Scalar>(joint_transforms), *executor_);
    }

    /// Writes all vertices, 3 x mesh vertices; methods without iterations always report converged.
    template <class Observer = NoObserver>
    SolveReport<Scalar> pose_into(AnimationMethod method, Transforms joint_transforms, Matrix3X<Scalar>& x,
                                  const NewtonOptions<Scalar>& options = quasi_static_options<Scalar>(),
                                  const Observer& observer = {}) {
        skin_into(LinearBlend<Scalar>(), joint_transforms, x);
        SolveReport<Scalar> report{.status = SolveStatus::converged};
        switch (method) {
            case AnimationMethod::lbs:
                break;
            case AnimationMethod::dqs: {
                skin_into(DualQuaternion<Scalar>(), joint_transforms, other_);
                take_free_columns(other_, x);
                break;
            }
            case AnimationMethod::gradient:
                gradient_skin(joint_transforms, x);
                break;
            case AnimationMethod::projective: {
                gradient_skin(joint_transforms, x);
                report.iterations = projected(x, 30);
                break;
            }
            case AnimationMethod::corotated: {
                if (!corotated_.solve_into(blended_rotations(joint_transforms), x)) {
                    report.status = SolveStatus::linear_solver_failed;
                }
                break;
            }
            case AnimationMethod::fem: {
                gradient_skin(joint_transforms, x);
                report = flesh_.solve_into(x, options, observer);
                break;
            }
        }
        return report;
    }

    /// Mean distance over the free vertices [m] between the equilibrium x of a pose and the one that is found from ten
    /// projective rounds: more than the solver's tolerance where a pose has several equilibria. Infinity where that solve fails.
    Scalar start_dependence(Transforms joint_transforms, const Matrix3X<Scalar>& x,
                            const NewtonOptions<Scalar>& options = quasi_static_options<Scalar>()) {
        skin_into(LinearBlend<Scalar>(), joint_transforms, other_);
        gradient_skin(joint_transforms, other_);
        projected(other_, 10);
        if (!flesh_.solve_into(other_, options).succeeded()) {
            return std::numeric_limits<Scalar>::infinity();
        }
        return (x - other_).colwise().norm().sum() / Scalar(poisson_.prescribed().num_free());
    }

private:
    template <class Policy>
    void skin_into(const Policy& policy, Transforms joint_transforms, Matrix3X<Scalar>& x) {
        skin_points_into(policy, joint_transforms, body_->weights, body_->mesh.rest_positions, prepared_joints_, x,
                         *executor_);
    }

    void gradient_skin(Transforms joint_transforms, Matrix3X<Scalar>& x) {
        gradient_skinning_.solve_into(bone_quaternions<Scalar>(joint_transforms), x, *executor_);
    }

    int projected(Matrix3X<Scalar>& x, int rounds) {
        return local_global_.solve_into(x, {.max_iterations = rounds}, *executor_).iterations;
    }

    void take_free_columns(const Matrix3X<Scalar>& from, Matrix3X<Scalar>& x) const {
        for (const std::int32_t v : poisson_.prescribed().free_vertices()) {
            x.col(v) = from.col(v);
        }
    }

    const LayeredBody<Scalar>* body_;
    const ExecutorType* executor_;
    PoissonReconstruction<Prism6, Scalar> poisson_;
    GradientSkinning<Prism6, Scalar> gradient_skinning_;
    LocalGlobal<Prism6, Scalar> local_global_;
    CorotatedLinearSolver<Prism6, Scalar, ExecutorType, Cholesky> corotated_;
    LayeredFlesh<Scalar, ExecutorType, LinearSolver> flesh_;
    MatrixX<Scalar> prepared_joints_;
    Matrix3X<Scalar> other_;
};

}  // namespace softtissue
