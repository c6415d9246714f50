// SPDX-License-Identifier: MIT
/// @file
/// A skinned body with a simulated layer of soft tissue.
///
/// What        poses go in, positions of the tissue come out: each step is one implicit Euler minimisation in which the
///             prescribed vertices follow the skinned shape and the rest is elastic.
/// Method      quasi-Newton steps in the metric of the body at rest, factored once; Newton's method with the same metric where
///             these converge slowly, which very soft or strongly strained tissue makes them do
/// Equation    M x'' - f = 0, C_B x = C_B p(rest, pose); f from an elastic energy measured in a strain frame
/// Shapes      positions, displacement 3 x vertices of the mesh [m]; x = p + A d (energy/placement.hpp)
/// Parameters  Element x MaterialField x StrainFrame x SkinningPolicy x Executor x metric
/// Units       density kg/m^3, time step s
/// Refuses     a mesh or model that do not fit, cells that are not positive at rest, a density or time step that is not positive
/// Cost        step() allocates in the first steps only
/// Threads     one avatar belongs to one thread at a time; it may use an executor of many
/// Source      Romero et al. 2020, sec. 3.4, 4.1, 4.2
/// Departs     the unknown is the unposed displacement, so the inverse of a blended skinning matrix is never taken
/// Example     examples/soft_tissue_avatar.cpp
/// Tests       tests/unit/avatar/soft_tissue_avatar_test.cpp, tests/scenario/static_pose_test.cpp, tests/scenario/motion_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/energy/strain_frame.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/implicit_euler.hpp>
#include <softtissue/solver/metric_cg.hpp>
#include <softtissue/solver/newton_workspace.hpp>
#include <softtissue/solver/quasi_newton.hpp>
#include <softtissue/solver/scalar_metric.hpp>

#include <cstdint>
#include <span>

namespace softtissue {

template <RealScalar S>
struct AvatarOptions {
    S density = S(1000);          ///< [kg/m^3]
    S time_step = S(1) / S(120);  ///< [s]
    /// A time step ends where about `tolerance` is left of the way to its minimum. max_steps = 0: Newton's method only.
    QuasiNewtonOptions<S> quasi_newton = {};
    /// Where quasi-Newton steps converge slowly; the error is far smaller than this step.
    NewtonOptions<S> newton = {.max_iterations = 50, .step_tolerance = S(1e-5)};
};

template <class ElementType, MaterialField Field, class Frame = UnposedFrame,
          SkinningPolicy Policy = LinearBlend<typename MaterialOf<Field>::Scalar>,
          Executor ExecutorType = SequentialExecutor, class Metric = ScalarMetric<typename MaterialOf<Field>::Scalar>>
    requires StrainFrame<Frame, ElasticEnergy<ElementType, Field>>
class SoftTissueAvatar {
public:
    using Scalar = typename MaterialOf<Field>::Scalar;
    using Elastic = ElasticEnergy<ElementType, Field>;
    using Model = VolumetricSmpl<Scalar, Policy>;
    using Mesh = CellMesh<ElementType, Scalar>;

    /// `model` skins the vertices of `mesh`, whose rest positions are the model's at its current shape. `prescribed` vertices
    /// follow the skinned shape. The executor must outlive the avatar, which starts at rest in the rest pose.
    SoftTissueAvatar(Model model, Mesh mesh, std::span<const std::int32_t> prescribed, Field field,
                     const ExecutorType& executor, const AvatarOptions<Scalar>& options = {})
        : options_(options),
          model_(std::move(model)),
          mesh_(fitting(std::move(mesh), model_)),
          prescribed_(mesh_.num_vertices(), prescribed),
          executor_(&executor),
          elastic_(mesh_, std::move(field)),
          euler_(lumped_masses(mesh_, options.density), options.time_step, prescribed_, mesh_.rest_positions,
                 linear_solver_, executor, elastic_) {
        displacement_.setZero(3, mesh_.num_vertices());
        euler_.placement().origins = mesh_.rest_positions;
        metric_.factorize(euler_.objective().hessian(displacement_, PsdFilter::none),
                          "soft-tissue avatar, stiffness at rest");
        start(Pose<Scalar>::rest(model_.num_joints()));
    }

    SoftTissueAvatar(const SoftTissueAvatar&) = delete;
    SoftTissueAvatar& operator=(const SoftTissueAvatar&) = delete;

    const Mesh& mesh() const { return mesh_; }
    const Model& model() const { return model_; }
    const AvatarOptions<Scalar>& options() const { return options_; }
    const PrescribedVertices& prescribed() const { return prescribed_; }
    const Elastic& elastic() const { return elastic_; }

    /// World positions of the tissue, 3 x vertices [m].
    const Matrix3X<Scalar>& positions() const { return euler_.state().positions; }
    const Matrix3X<Scalar>& velocities() const { return euler_.state().velocities; }
    /// The skinned shape p of the current pose.
    const Matrix3X<Scalar>& skinned() const { return skinned_.origins; }
    /// The body of the current pose: skinned shape, transforms, pose blend shapes.
    const PosedBody<Scalar>& posed() const { return posed_; }
    /// The solver's displacement d; in unposed space for the unposed frame, else in the world.
    const Matrix3X<Scalar>& displacement() const { return displacement_; }
    /// Cells whose deformation gradient has det F <= 0 now.
    Index count_inverted() const { return elastic_.count_inverted(displacement_); }

    /// Puts the tissue on the skinned shape of `pose`, without velocity.
    void start(const Pose<Scalar>& pose) {
        set_pose(pose);
        displacement_.setZero();
        carried_.setZero(3, mesh_.num_vertices());
        last_carried_ = carried_;
        euler_.set_state({skinned_.origins, Matrix3X<Scalar>::Zero(3, mesh_.num_vertices())});
    }

    /// The same in motion: with the velocity of a body that was in pose `previous` one time step ago.
    void start(const Pose<Scalar>& previous, const Pose<Scalar>& pose) {
        start(previous);
        const Matrix3X<Scalar> before = skinned_.origins;
        start(pose);
        euler_.set_state({skinned_.origins, (skinned_.origins - before) / options_.time_step});
    }

    /// Advances one time step into `pose`. `observer` sees NewtonProgress and may cancel.
    template <class Observer = NoObserver>
    SolveReport<Scalar> step(const Pose<Scalar>& pose, const Observer& observer = {}) {
        set_pose(pose);
        carry_into(carried_, displacement_);
        extrapolated_ = Scalar(2) * carried_ - last_carried_;
        carry_into(extrapolated_, extrapolated_);
        SolveReport<Scalar> report =
            euler_.step_by([&](auto& objective, Matrix3X<Scalar>& d) { return solve(objective, d, observer); },
                           displacement_, {&extrapolated_});
        last_carried_.swap(carried_);
        carry_back();
        return report;
    }

    /// Static equilibrium at `pose`, started from the current displacement; then without velocity.
    template <class Observer = NoObserver>
    SolveReport<Scalar> settle(const Pose<Scalar>& pose, const NewtonOptions<Scalar>& options = {},
                               const Observer& observer = {}) {
        set_pose(pose);
        carry_into(carried_, displacement_);
        Objective statics(prescribed_, *executor_, elastic_);
        DirectSolver<Scalar> direct;
        SolveReport<Scalar> report = minimise(statics, direct, displacement_, options, observer);
        carry_back();
        last_carried_ = carried_;
        Matrix3X<Scalar> x;
        euler_.placement().positions_into(displacement_, x);
        euler_.set_state({x, Matrix3X<Scalar>::Zero(3, mesh_.num_vertices())});
        return report;
    }

private:
    static Mesh fitting(Mesh mesh, const Model& model) {
        require(mesh.num_vertices() == model.num_vertices(), "soft-tissue avatar: mesh has ", mesh.num_vertices(),
                " vertices, the skinned model ", model.num_vertices());
        const Scalar largest = (mesh.rest_positions - model.rest_vertices()).cwiseAbs().maxCoeff();
        require(largest <= Scalar(1e-6), "soft-tissue avatar: rest positions of mesh and model differ by ", largest,
                " m, expected the same shape");
        return mesh;
    }

    template <class ObjectiveType, class Observer>
    SolveReport<Scalar> solve(ObjectiveType& objective, Matrix3X<Scalar>& d, const Observer& observer) {
        SolveReport<Scalar> fast;
        if (options_.quasi_newton.max_steps > 0) {
            fast = quasi_newton_.minimise(objective, metric_, d, options_.quasi_newton, observer);
            if (fast.succeeded() || fast.status == SolveStatus::cancelled || fast.status == SolveStatus::not_finite) {
                return fast;
            }
        }
        SolveReport<Scalar> report = minimise(objective, linear_solver_, d, options_.newton, observer, workspace_);
        report.quasi_newton_steps += fast.quasi_newton_steps;
        report.energy_evaluations += fast.energy_evaluations;
        return report;
    }

    void set_pose(const Pose<Scalar>& pose) {
        model_.pose_into(pose, posed_, *executor_);
        const Index n = mesh_.num_vertices();
        skinned_.origins = posed_.positions;
        skinned_.maps.resize(3, 3 * n);
        for (Index v = 0; v < n; ++v) {
            skinned_.maps.template middleCols<3>(3 * v) = posed_.transforms[size_t(v)].linear;
        }
        Frame::apply(mesh_, skinned_, elastic_, euler_.placement());
        if constexpr (!Frame::is_unposed) {
            rotations_.resize(3, 3 * n);
            for (Index v = 0; v < n; ++v) {
                rotations_.template middleCols<3>(3 * v) = polar_rotation(posed_.transforms[size_t(v)].linear);
            }
            Matrix3X<Scalar>& maps = metric_.maps();
            maps.resize(3, 3 * prescribed_.num_free());
            for (Index i = 0; i < prescribed_.num_free(); ++i) {
                const Index v = prescribed_.free_vertices()[size_t(i)];
                maps.template middleCols<3>(3 * i) = rotations_.template middleCols<3>(3 * v);
            }
        }
    }

    /// From the body's own axes, in which a displacement keeps its meaning over poses, to the solver's.
    void carry_into(const Matrix3X<Scalar>& carried, Matrix3X<Scalar>& displacement) const {
        if constexpr (Frame::is_unposed) {
            displacement = carried;
        } else {
            displacement.resize(3, carried.cols());
            for (Index v = 0; v < carried.cols(); ++v) {
                displacement.col(v) = (rotations_.template middleCols<3>(3 * v) * carried.col(v)).eval();
            }
        }
    }

    void carry_back() {
        if constexpr (Frame::is_unposed) {
            carried_ = displacement_;
        } else {
            for (Index v = 0; v < carried_.cols(); ++v) {
                carried_.col(v).noalias() = rotations_.template middleCols<3>(3 * v).transpose() * displacement_.col(v);
            }
        }
    }

    AvatarOptions<Scalar> options_;
    Model model_;
    Mesh mesh_;
    PrescribedVertices prescribed_;
    const ExecutorType* executor_;
    Elastic elastic_;
    Metric metric_;
    MetricCg<Metric> linear_solver_{metric_};
    QuasiNewton<Scalar> quasi_newton_;
    NewtonWorkspace<Scalar> workspace_;
    ImplicitEuler<MetricCg<Metric>, ExecutorType, Elastic> euler_;
    PosedBody<Scalar> posed_;
    Placement<Scalar> skinned_;
    Matrix3X<Scalar> rotations_;  // 3 x 3 vertices, world frames only
    Matrix3X<Scalar> displacement_, carried_, last_carried_, extrapolated_;
};

}  // namespace softtissue
