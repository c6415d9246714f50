// SPDX-License-Identifier: MIT
// A quasi-static pose to a Newton decrement of 1e-4 J, mean over poses of a limb of the paper's size: LayeredFlesh beside the same
// Newton's method, filter, line search and skin with one scalar element after the other, triplets and CHOLMOD in each iteration.
// Times are per pose. Arguments: prisms, poses (evenly spaced among twenty).

#include "machine_limits.hpp"
#include "paper_body.hpp"
#include "plain_triplets.hpp"
#include "posed_limb.hpp"

#include <examples/support/embedded_human.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/convexified.hpp>
#include <softtissue/energy/dihedral_chord.hpp>
#include <softtissue/energy/edge_stretch.hpp>
#include <softtissue/energy/hinge_bending.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/ndg/sample_generator.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <benchmark/benchmark.h>

#include <Eigen/SparseCore>

#ifdef SOFTTISSUE_HAS_CHOLMOD
#include "tuned_cholmod.hpp"
#endif

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace softtissue;
using namespace benchmarks;

/// A limb and what all solves on it start from; kept for the next benchmark.
struct Scene {
    PosedLimb<double> limb;
    std::vector<Matrix3X<double>> starts;

    explicit Scene(Index around) : limb(around) {
        PoseStarts start_of(limb);
        for (int pose = 0; pose < limb.num_poses; ++pose) {
            starts.push_back(start_of(pose));
        }
    }
};

/// 13 prisms a squared column around.
Index columns_around(const benchmark::State& state) {
    return Index(std::lround(std::sqrt(double(state.range(0)) / 13)));
}

const Scene& scene_of(const benchmark::State& state) {
    static std::map<Index, Scene> scenes;
    const Index around = columns_around(state);
    return scenes.try_emplace(around, around).first->second;
}

/// `solve(x)` solves from x.
template <class S, class Solve>
void solve_poses(benchmark::State& state, const Solve& solve) {
    const Scene& scene = scene_of(state);
    std::int64_t count = 0;
    double iterations = 0, between = 0, linear = 0, energy = 0, unfinished = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const std::int64_t pose = count++ % state.range(1) * scene.limb.num_poses / state.range(1);
        Matrix3X<S> x = scene.starts[size_t(pose)].template cast<S>();
        state.ResumeTiming();
        const SolveReport<S> report = solve(x);
        unfinished += report.succeeded() ? 0 : 1;
        iterations += report.iterations;
        between += report.quasi_newton_steps;
        linear += report.linear_iterations;
        energy += double(report.energy);
    }
    const auto mean = [](double sum) { return benchmark::Counter(sum, benchmark::Counter::kAvgIterations); };
    state.counters["Newton iterations"] = mean(iterations);
    state.counters["steps between"] = mean(between);
    state.counters["linear iterations"] = mean(linear);
    state.counters["energy J"] = mean(energy);
    state.counters["poses not finished"] = benchmark::Counter(unfinished);
    count_work<S>(state, {.unit = "poses", .items = 1});
}

template <class S, class Inner>
void layered_flesh(benchmark::State& state) {
    const PosedLimb<S> limb(columns_around(state));
    const SequentialExecutor executor;
    LayeredFlesh<S, SequentialExecutor, GaussSeidelCg<S, Inner>> flesh(limb.body, {}, executor);
    solve_poses<S>(state, [&](Matrix3X<S>& x) { return flesh.solve_into(x); });
}

/// A sample of a data set: the body of the paper's size in poses of jumping jacks, or of the embedded body's jump.
void sample(benchmark::State& state) {
    const PaperBody& body = paper_body();
    const ShapedBody<double> shaped{body.layered, body.joints};
    SampleGenerator<double> generator(shaped, body.tree, sample_options<double>());
    const std::string path = SOFTTISSUE_SHARED_DIR "/data/motion/jumping_jacks.npz";
    const Motion<double> motion =
        examples::read_human_motion(std::filesystem::exists(path) ? path : "", body.tree.num_joints());
    std::int64_t count = 0;
    double iterations = 0;
    for (auto _ : state) {
        const Pose<double>& pose =
            motion.poses[size_t(motion.num_frames() * (count++ % state.range(1)) / state.range(1))];
        const GeneratedSample<double> result = generator.generate(pose);
        require(result.succeeded(), "sample ", count, ": ", result.failure);
        iterations += result.report.iterations;
    }
    state.counters["prisms"] = double(body.layered.mesh.num_cells());
    state.counters["Newton iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
    count_work<double>(state, {.unit = "samples", .items = 1});
}

#ifdef SOFTTISSUE_HAS_CHOLMOD

/// The same energy; the flesh one cell after the other with the plain law, the Hessian by triplets.
class PlainObjective {
public:
    using Scalar = double;

    explicit PlainObjective(const LayeredBody<double>& body) : body_(body) {
        for (const LameParameters<double>& lame : layer_moduli(body, parameters_)) {
            materials_.push_back(StableNeoHookean<double>({.mu = lame.mu, .lambda = lame.lambda}));
        }
    }

    const PrescribedVertices& prescribed() const { return prescribed_; }
    const SequentialExecutor& executor() const { return executor_; }

    double energy(const Matrix3X<double>& d) {
        double sum = skin_.energy(d);
        for_each_cell(d, [&](Index c, const auto& F, const auto&, double V) {
            sum += V * materials_[size_t(c)].energy_density(F);
        });
        return sum;
    }

    const VectorX<double>& gradient(const Matrix3X<double>& d) {
        full_gradient_ = skin_.full_gradient(d);
        for_each_cell(d, [&](Index c, const auto& F, const auto& g, double V) {
            const NodePositions<Prism6, double> forces = V * materials_[size_t(c)].first_piola(F) * g;
            for (int a = 0; a < 6; ++a) {
                full_gradient_.col(mesh().cells(a, c)) += forces.col(a);
            }
        });
        prescribed_.restrict_into(full_gradient_, gradient_);
        return gradient_;
    }

    /// The skin's stiffness comes summed up already.
    const Eigen::SparseMatrix<double>& hessian(const Matrix3X<double>& d, PsdFilter filter) {
        triplets_.clear();
        const Eigen::SparseMatrix<double>& skin = skin_.hessian(d, filter).matrix();
        for (Index j = 0; j < skin.cols(); ++j) {
            for (Eigen::SparseMatrix<double>::InnerIterator entry(skin, j); entry; ++entry) {
                triplets_.emplace_back(int(entry.row()), int(j), entry.value());
            }
        }
        for_each_cell(d, [&](Index c, const auto& F, const auto& g, double V) {
            append_prism<double>(V * projected_hessian(materials_[size_t(c)], F, filter), g, mesh().cells, c,
                                 prescribed_, triplets_);
        });
        hessian_.setFromTriplets(triplets_.begin(), triplets_.end());
        return hessian_;
    }

private:
    using Stretch = EdgeStretch<double>;
    using Bending = HingeBending<DihedralChord<double>>;

    const CellMesh<Prism6, double>& mesh() const { return body_.mesh; }

    template <class Visit>
    void for_each_cell(const Matrix3X<double>& d, const Visit& visit) {
        for (Index c = 0; c < mesh().num_cells(); ++c) {
            const NodePositions<Prism6, double> g = rest_.cell_gradients(c);
            const Matrix3<double> F =
                Matrix3<double>::Identity() + mesh().gather(d, mesh().cells.col(c)) * g.transpose();
            visit(c, F, g, rest_.volumes(c));
        }
    }

    const LayeredBody<double>& body_;
    FleshParameters<double> parameters_;
    SequentialExecutor executor_;
    PrescribedVertices prescribed_{mesh().num_vertices(), body_.prescribed};
    RestOperators<Prism6, double> rest_ = RestOperators<Prism6, double>::at(mesh(), mesh().rest_positions);
    std::vector<StableNeoHookean<double>> materials_;
    Stretch stretch_{skin_surface(body_), mesh().rest_positions, parameters_.stretch};
    Bending bending_{skin_surface(body_), mesh().rest_positions, parameters_.bending};
    Convexified<Stretch> convex_stretch_{stretch_};
    Convexified<Bending> convex_bending_{bending_};
    Objective<SequentialExecutor, Convexified<Stretch>, Convexified<Bending>> skin_{
        PrescribedVertices(mesh().num_vertices(), body_.prescribed), executor_, convex_stretch_, convex_bending_};
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::SparseMatrix<double> hessian_{3 * prescribed_.num_free(), 3 * prescribed_.num_free()};
    Matrix3X<double> full_gradient_;
    VectorX<double> gradient_;
};

/// CHOLMOD, its analysis kept from pose to pose.
class CholmodSolver {
public:
    using Scalar = double;

    template <class Matrix, Executor E>
    LinearSolveResult solve(const Matrix& H, const VectorX<double>& rhs, double, VectorX<double>& p, const E&) {
        if (!cholmod_.is_analyzed()) {
            cholmod_.analyzePattern(H);
        }
        if (!cholmod_.factorize(H)) {
            return {.is_positive_definite = false, .iterations = 0};
        }
        p = cholmod_.solve(rhs);
        return {.is_positive_definite = true, .iterations = 0};
    }

    void solve_again(const VectorX<double>& rhs, VectorX<double>& p) { p = cholmod_.solve(rhs); }

private:
    TunedCholmod<CHOLMOD_SUPERNODAL, CHOLMOD_AMD> cholmod_;
};

/// With as many steps between the iterations, which reuse the last factor, as LayeredFlesh takes, or none.
template <bool has_steps_between>
void plain_elements_and_cholmod(benchmark::State& state) {
    const LayeredBody<double>& body = scene_of(state).limb.body;
    PlainObjective objective(body);
    CholmodSolver solver;
    NewtonOptions<double> options = quasi_static_options<double>();
    options.quasi_newton_steps = has_steps_between ? options.quasi_newton_steps : 0;
    options.max_iterations = 400;  // one of the poses takes more than the 100 that are enough with steps between
    solve_poses<double>(state, [&](Matrix3X<double>& x) {
        x -= body.mesh.rest_positions;
        return minimise(objective, solver, x, options);
    });
}

#endif

#define SOFTTISSUE_POSE "8 a quasi-static pose/"

/// The limb of the paper's size takes minutes, the other one is for tests.
void paper_size(benchmark::internal::Benchmark* one) {
    one->ArgNames({"prisms", "poses"})
        ->Args({53248, 20})
        ->Iterations(20)
        ->Repetitions(1)
        ->Unit(benchmark::kMillisecond);
}
void small_size(benchmark::internal::Benchmark* one) {
    one->ArgNames({"prisms", "poses"})->Args({3328, 2})->Iterations(2)->Unit(benchmark::kMillisecond);
}

BENCHMARK(layered_flesh<float, float>)->Name(SOFTTISSUE_POSE "float")->Apply(paper_size);
BENCHMARK(layered_flesh<double, float>)->Name(SOFTTISSUE_POSE "double")->Apply(paper_size);
BENCHMARK(layered_flesh<float, float>)->Name(SOFTTISSUE_POSE "float")->Apply(small_size);
BENCHMARK(layered_flesh<double, float>)->Name(SOFTTISSUE_POSE "double")->Apply(small_size);
BENCHMARK(sample)->Name("a sample of a data set/double")->Apply(paper_size);
#ifdef SOFTTISSUE_HAS_CHOLMOD
#define SOFTTISSUE_PLAIN SOFTTISSUE_POSE "baseline plain elements, triplets and CHOLMOD"
BENCHMARK(plain_elements_and_cholmod<false>)->Name(SOFTTISSUE_PLAIN)->Apply(paper_size);
BENCHMARK(plain_elements_and_cholmod<true>)->Name(SOFTTISSUE_PLAIN " and steps between")->Apply(paper_size);
BENCHMARK(plain_elements_and_cholmod<false>)->Name(SOFTTISSUE_PLAIN)->Apply(small_size);
BENCHMARK(plain_elements_and_cholmod<true>)->Name(SOFTTISSUE_PLAIN " and steps between")->Apply(small_size);
#endif

}  // namespace
