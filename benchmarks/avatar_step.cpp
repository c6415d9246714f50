// SPDX-License-Identifier: MIT
// A body in motion, stepped frame by frame: soft_tissue_avatar.hpp beside Newton's method with plain elements, triplets and a sparse
// factorisation in each iteration. Both run freely; "error" is the largest distance of any vertex in any frame from the trajectory of
// converged steps. The body is body_small of the shared data in jumping jacks, simulated from head to toe (41,340 unknowns), or the
// embedded body in its jump.
#include "machine_limits.hpp"
#include "plain_triplets.hpp"

#include <examples/support/embedded_human.hpp>
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/skinning/resample.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#ifdef SOFTTISSUE_HAS_CHOLMOD
#include <softtissue/sparse/cholmod.hpp>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace softtissue;

constexpr double time_step = 1.0 / 120.0;

std::string shared_file(const char* name) {
    const std::string path = SOFTTISSUE_SHARED_DIR "/data/" + std::string(name);
    return std::filesystem::exists(path) ? path : std::string();
}

struct Scene {
    SmplBody<double> body = examples::read_human(shared_file("body/body_small.npz"));
    SoftLayer<double> layer = make_soft_layer(body, {.region = {.extremities = JointGroups{}}});
    VolumetricSmpl<double> tissue = make_tissue_model(VolumetricSmpl<double>(body), layer);
    Motion<double> motion = resample(
        examples::read_human_motion(shared_file("motion/jumping_jacks.npz"), body.num_joints()), 1 / time_step);
    std::vector<Matrix3<double>> bases = orthotropy_bases<double>(layer.mesh.cells, column_normals(layer));
};

const Scene& scene() {
    static const Scene result;
    return result;
}

template <class S>
using Avatar = SoftTissueAvatar<Prism6, FungOrthotropicField<S>>;
const SequentialExecutor one_thread;

template <class S>
FungOrthotropicField<S> field() {
    typename FungOrthotropicField<S>::Bases bases(9, Index(scene().bases.size()));
    for (Index c = 0; c < bases.cols(); ++c) {
        bases.col(c) = vec<S>(scene().bases[size_t(c)].template cast<S>());
    }
    return FungOrthotropicField<S>({.normal_modulus = S(5e3), .tangential_modulus = S(1e4)}, bases);
}

template <class S>
CellMesh<Prism6, S> mesh() {
    return {scene().layer.mesh.rest_positions.template cast<S>(), scene().layer.mesh.cells};
}

template <class S>
Pose<S> pose(Index frame) {
    const Pose<double>& pose = scene().motion.poses[size_t(frame)];
    return {pose.rotation_vectors.template cast<S>(), pose.translation.template cast<S>()};
}

/// Where runs begin: half a second into the motion.
constexpr Index first_frame = 60;

/// Frame k of steps that are converged to a tenth of a micrometre.
const Matrix3X<float>& converged(Index frame) {
    static std::vector<Matrix3X<float>> frames;
    static Avatar<double> avatar(scene().tissue, mesh<double>(), scene().layer.prescribed_vertices, field<double>(),
                                 one_thread, {.quasi_newton = {.tolerance = 1e-7, .max_steps = 60}});
    if (frames.empty()) {
        avatar.start(pose<double>(first_frame - 2), pose<double>(first_frame - 1));
    }
    while (Index(frames.size()) <= frame - first_frame) {
        require(avatar.step(pose<double>(first_frame + Index(frames.size()))).succeeded(), "a step did not converge");
        frames.push_back(avatar.positions().cast<float>());
    }
    return frames[size_t(frame - first_frame)];
}

/// One step an iteration, over the motion and from its beginning again. `step(frame)` is timed by the clock.
template <class Start, class Step, class Positions>
void run_freely(benchmark::State& state, const Start& start, const Step& step, const Positions& positions) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> milliseconds;
    double error = 0;
    Index frame = scene().motion.num_frames();
    for (auto _ : state) {
        if (frame == scene().motion.num_frames()) {
            frame = first_frame;
            start();
        }
        const Clock::time_point begin = Clock::now();
        step(frame);
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        state.SetIterationTime(seconds);
        milliseconds.push_back(1e3 * seconds);
        error = std::max(error, double((positions() - converged(frame)).colwise().norm().maxCoeff()));
        ++frame;
    }
    std::sort(milliseconds.begin(), milliseconds.end());
    state.counters["median ms"] = milliseconds[milliseconds.size() / 2];
    state.counters["p95 ms"] = milliseconds[milliseconds.size() * 95 / 100];
    state.counters["max ms"] = milliseconds.back();
    state.counters["error mm"] = 1e3 * error;
    benchmarks::count_work<float>(state, {.unit = "frames", .items = 1});
}

template <class S>
void avatar_step(benchmark::State& state) {
    Avatar<S> avatar(scene().tissue.template cast<S>(), mesh<S>(), scene().layer.prescribed_vertices, field<S>(),
                     one_thread);
    int newton = 0, steps = 0;
    run_freely(
        state, [&] { avatar.start(pose<S>(first_frame - 2), pose<S>(first_frame - 1)); },
        [&](Index frame) {
            const SolveReport<S> report = avatar.step(pose<S>(frame));
            newton += report.iterations;
            steps += report.quasi_newton_steps;
        },
        [&] { return Matrix3X<float>(avatar.positions().template cast<float>()); });
    state.counters["quasi-Newton steps"] = benchmark::Counter(steps, benchmark::Counter::kAvgIterations);
    state.counters["Newton iterations"] = benchmark::Counter(newton, benchmark::Counter::kAvgIterations);
}

#ifdef SOFTTISSUE_HAS_CHOLMOD
using Factorisation = Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower>;
#else
using Factorisation = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower>;
#endif

/// The same energy without packs, without slots: one cell after the other, triplets, and a matrix sorted from them.
class PlainObjective {
public:
    using Scalar = double;

    PlainObjective()
        : mesh_(mesh<double>()),
          field_(field<double>()),
          prescribed_(mesh_.num_vertices(), scene().layer.prescribed_vertices),
          rest_(RestOperators<Prism6, double>::at(mesh_, mesh_.rest_positions)),
          inertia_(free_masses(), time_step) {
        inertia_.set_step(placement, target);
    }

    Placement<double> placement;
    Matrix3X<double> target;

    const PrescribedVertices& prescribed() const { return prescribed_; }
    const SequentialExecutor& executor() const { return one_thread; }

    double energy(const Matrix3X<double>& d) {
        double sum = inertia_.energy(d, executor());
        for (Index c = 0; c < mesh_.num_cells(); ++c) {
            sum += rest_.volumes(c) * field_.at(c).energy_density(deformation_gradient(d, c));
        }
        return sum;
    }
    const VectorX<double>& gradient(const Matrix3X<double>& d) {
        Matrix3X<double> full = Matrix3X<double>::Zero(3, d.cols());
        inertia_.add_gradient(d, full, executor());
        for (Index c = 0; c < mesh_.num_cells(); ++c) {
            const NodePositions<Prism6, double> forces =
                rest_.volumes(c) * field_.at(c).first_piola(deformation_gradient(d, c)) * rest_.cell_gradients(c);
            for (int a = 0; a < 6; ++a) {
                full.col(mesh_.cells(a, c)) += forces.col(a);
            }
        }
        prescribed_.restrict_into(full, gradient_);
        return gradient_;
    }
    const Eigen::SparseMatrix<double>& hessian(const Matrix3X<double>& d, PsdFilter filter) {
        triplets_.clear();
        for (Index j = 0; j < prescribed_.num_free(); ++j) {
            const Index v = prescribed_.free_vertices()[size_t(j)];
            const double stiffness = inertia_.masses()(v) / (time_step * time_step);
            benchmarks::append_block<double>(j, j, stiffness * placement.map(v).transpose() * placement.map(v),
                                             triplets_);
        }
        for (Index c = 0; c < mesh_.num_cells(); ++c) {
            benchmarks::append_prism<double>(
                rest_.volumes(c) * projected_hessian(field_.at(c), deformation_gradient(d, c), filter),
                rest_.cell_gradients(c), mesh_.cells, c, prescribed_, triplets_);
        }
        hessian_.resize(3 * prescribed_.num_free(), 3 * prescribed_.num_free());
        hessian_.setFromTriplets(triplets_.begin(), triplets_.end());
        return hessian_;
    }

private:
    Matrix3<double> deformation_gradient(const Matrix3X<double>& d, Index cell) const {
        return Matrix3<double>::Identity() +
               mesh_.gather(d, mesh_.cells.col(cell)) * rest_.cell_gradients(cell).transpose();
    }
    VectorX<double> free_masses() const {
        VectorX<double> masses = lumped_masses(mesh_, 1000.0);
        for (const std::int32_t v : scene().layer.prescribed_vertices) {
            masses(v) = 0;
        }
        return masses;
    }

    CellMesh<Prism6, double> mesh_;
    FungOrthotropicField<double> field_;
    PrescribedVertices prescribed_;
    RestOperators<Prism6, double> rest_;
    Inertia<double> inertia_;
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::SparseMatrix<double> hessian_;
    VectorX<double> gradient_;
};

/// Analysed once, factored anew for each system.
struct PlainSolver {
    using Scalar = double;
    Factorisation factorisation;
    bool is_analysed = false;

    template <class Matrix, class E>
    LinearSolveResult solve(const Matrix& H, const VectorX<double>& rhs, double, VectorX<double>& p, const E&) {
        if (!is_analysed) {
            factorisation.analyzePattern(H);
            is_analysed = true;
        }
        factorisation.factorize(H);
        if (factorisation.info() != Eigen::Success) {
            return {.is_positive_definite = false, .iterations = 0};
        }
        p = factorisation.solve(rhs);
        return {.is_positive_definite = true, .iterations = 0};
    }
};

void plain_newton_step(benchmark::State& state) {
    PlainObjective objective;
    PlainSolver solver;
    const VolumetricSmpl<double>& tissue = scene().tissue;
    PosedBody<double> posed;
    Matrix3X<double> x, v, next, d = Matrix3X<double>::Zero(3, tissue.num_vertices()), last = d;
    int newton = 0;
    const auto set_pose = [&](Index frame) {
        tissue.pose_into(pose<double>(frame), posed);
        objective.placement.origins = posed.positions;
        objective.placement.maps.resize(3, 3 * tissue.num_vertices());
        for (Index i = 0; i < tissue.num_vertices(); ++i) {
            objective.placement.maps.middleCols<3>(3 * i) = posed.transforms[size_t(i)].linear;
        }
    };
    run_freely(
        state,
        [&] {
            set_pose(first_frame - 2);
            v = objective.placement.origins;
            set_pose(first_frame - 1);
            d.setZero();
            last = d;
            x = objective.placement.origins;
            v = ((x - v) / time_step).eval();
        },
        [&](Index frame) {
            set_pose(frame);
            objective.target = x + time_step * v;
            const Matrix3X<double> start = 2 * d - last;
            last = d;
            if (objective.energy(start) < objective.energy(d)) {
                d = start;
            }
            // its last step is applied: what it leaves is far below the tolerance of the avatar
            newton += minimise(objective, solver, d, {.step_tolerance = 2e-4}).iterations;
            objective.placement.positions_into(d, next);
            v = (next - x) / time_step;
            x = next;
        },
        [&] { return Matrix3X<float>(x.cast<float>()); });
    state.counters["Newton iterations"] = benchmark::Counter(newton, benchmark::Counter::kAvgIterations);
}

void by_the_clock(benchmark::internal::Benchmark* benchmark) {
    benchmark->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(avatar_step<float>)->Name("9 avatar step/float")->Apply(by_the_clock);
BENCHMARK(avatar_step<double>)->Name("9 avatar step/double")->Apply(by_the_clock);
BENCHMARK(plain_newton_step)
    ->Name("9 avatar step/baseline Newton with plain elements and triplets")
    ->Apply(by_the_clock);

}  // namespace
