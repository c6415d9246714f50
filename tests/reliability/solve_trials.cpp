// SPDX-License-Identifier: MIT
#include "solve_trials.hpp"

#include <softtissue/energy/dead_load.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/solver/continuation.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/implicit_euler.hpp>
#include <softtissue/solver/objective.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reliability {

namespace {

const SequentialExecutor executor;

double log_uniform(double low, double high, RandomGenerator& random) {
    return std::exp(random.uniform(std::log(low), std::log(high)));
}

Tissue random_tissue(RandomGenerator& random) {
    // one in four nearly incompressible
    const double nu = random.uniform() < 0.25 ? 0.499 : random.uniform(0.0, 0.499);
    return {log_uniform(1e2, 1e7, random), nu, random.bits()};
}

Matrix3<double> turned(RandomGenerator& random) {
    // exactly half a turn about an axis, or any angle up to two turns about any
    Vector3<double> axis(random.normal(), random.normal(), random.normal());
    axis.normalize();
    double angle = random.uniform(-4 * std::numbers::pi, 4 * std::numbers::pi);
    if (random.uniform() < 0.25) {
        axis = Vector3<double>::Unit(random.index(3));
        angle = std::numbers::pi;
    }
    const Vector3<double> r = angle * axis;
    return rotation_matrix_from_rotation_vector<double>(r);
}

/// Where the vertices of the top go: pushed through the bottom, mirrored, turned, torn, crushed to a point, scattered.
Matrix3X<double> moved_top(const Matrix3X<double>& top, RandomGenerator& random) {
    const Vector3<double> centre = top.rowwise().mean();
    Matrix3<double> A = Matrix3<double>::Identity();
    Vector3<double> shift = Vector3<double>::Zero();
    switch (random.index(6)) {
        case 0:
            shift = Vector3<double>(0, 0, -random.uniform(1, 3) * (centre(2) + 1e-3));
            break;
        case 1:
            A(random.index(3), random.index(3)) = -1;
            break;
        case 2:
            A = turned(random);
            break;
        case 3:
            A *= random.uniform(0, 3);
            shift = Vector3<double>(random.normal(), random.normal(), random.normal());
            break;
        case 4:
            A.setZero();
            break;
        default: {
            Matrix3X<double> scattered = top;
            for (double& x : scattered.reshaped()) {
                x += random.normal();
            }
            return scattered;
        }
    }
    return (A * (top.colwise() - centre)).colwise() + (centre + shift);
}

template <class S>
std::vector<std::int32_t> held(const TrialBlock<S>& block, bool top_too) {
    std::vector<std::int32_t> result = block.bottom;
    if (top_too) {
        result.insert(result.end(), block.top.begin(), block.top.end());
    }
    return result;
}

/// The displacement of the top into a random place, everything else where it is.
template <class S>
Matrix3X<S> random_boundary(const TrialBlock<S>& block, RandomGenerator& random) {
    Matrix3X<double> top(3, Index(block.top.size()));
    for (size_t i = 0; i < block.top.size(); ++i) {
        top.col(Index(i)) = block.rest.col(block.top[i]).template cast<double>();
    }
    const Matrix3X<double> moved = moved_top(top, random);
    Matrix3X<S> d = Matrix3X<S>::Zero(3, block.rest.cols());
    for (size_t i = 0; i < block.top.size(); ++i) {
        d.col(block.top[i]) = (moved.col(Index(i)) - top.col(Index(i))).template cast<S>();
    }
    return d;
}

template <class S>
bool is_finite(const SolveReport<S>& report) {
    return std::isfinite(report.energy) && std::isfinite(report.residual);
}

template <class S>
Outcome outcome(const SolveReport<S>& report, const Matrix3X<S>& d) {
    Outcome result;
    result.status = report.status;
    result.is_finite = d.allFinite() && (report.status == SolveStatus::not_finite || is_finite(report));
    result.iterations = report.iterations;
    return result;
}

/// What is left of the way to rest. A solve that says that it has not ended there is asked again with more iterations.
template <class S, class ObjectiveType>
void measure_rest(ObjectiveType& objective, Matrix3X<S>& d, const NewtonOptions<S>& options, Outcome& result) {
    DirectSolver<S> solver;
    SolveReport<S> report;
    for (int attempt = 0; attempt < 3 && !report.succeeded(); ++attempt) {
        report = minimise(objective, solver, d, options);
    }
    result.has_rest = true;
    result.is_finite = result.is_finite && d.allFinite();
    result.iterations = std::max(result.iterations, report.iterations);
    result.distance = double(d.colwise().norm().maxCoeff());
}

template <class S>
NewtonOptions<S> precise() {
    return {.max_iterations = 200, .step_tolerance = sizeof(S) == 4 ? S(1e-6) : S(1e-10)};
}

/// The boundary goes through the block and comes back.
template <class S>
Outcome there_and_back(const TrialBlock<S>& block, RandomGenerator& random) {
    DeadLoad<S> load(Matrix3X<S>::Zero(3, block.rest.cols()));
    Objective objective(PrescribedVertices(block.rest.cols(), held(block, true)), executor, *block.elastic, load);
    DirectSolver<S> solver;
    Matrix3X<S> d = Matrix3X<S>::Zero(3, block.rest.cols());
    const Matrix3X<S> target = random_boundary(block, random);
    Outcome result;
    if (random.uniform() < 0.5) {
        d = target;
        result = outcome(minimise(objective, solver, d, precise<S>()), d);
    } else {
        const ContinuationOptions<S> options{.newton = precise<S>(), .iterations_per_increment = 30, .max_halvings = 6};
        result = outcome(follow_boundary(objective, solver, d, target, options), d);
    }
    result.may_stay = !(target.colwise().norm().maxCoeff() < S(0.5));
    for (const std::vector<std::int32_t>* side : {&block.bottom, &block.top}) {
        for (const std::int32_t v : *side) {
            d.col(v).setZero();
        }
    }
    measure_rest(objective, d, precise<S>(), result);
    return result;
}

/// Forces on the vertices, up to `largest` times modulus and face over all of them, then none.
template <class S>
Outcome loaded_and_released(const TrialBlock<S>& block, const Tissue& tissue, double largest, RandomGenerator& random) {
    Matrix3X<S> forces(3, block.rest.cols());
    const double size = log_uniform(1e-3, largest, random) * tissue.young_modulus / double(block.rest.cols());
    for (S& f : forces.reshaped()) {
        f = S(size * random.normal());
    }
    DeadLoad<S> load(forces);
    Objective objective(PrescribedVertices(block.rest.cols(), held(block, false)), executor, *block.elastic, load);
    DirectSolver<S> solver;
    Matrix3X<S> d = Matrix3X<S>::Zero(3, block.rest.cols());
    Outcome result = outcome(minimise(objective, solver, d, precise<S>()), d);
    // pushed through the face that holds it, a part of the block may stay there
    result.may_stay = !(d.colwise().norm().maxCoeff() < S(0.5));
    load.set_forces(Matrix3X<S>::Zero(3, block.rest.cols()));
    measure_rest(objective, d, precise<S>(), result);
    return result;
}

/// A few steps of a block that is thrown, torn and turned inside out, then held.
template <class S>
Outcome stepped(const TrialBlock<S>& block, RandomGenerator& random) {
    DeadLoad<S> load(Matrix3X<S>::Zero(3, block.rest.cols()));
    DirectSolver<S> solver;
    const S dt = S(log_uniform(1e-5, 1, random));
    ImplicitEuler euler(block.masses, dt, PrescribedVertices(block.rest.cols(), held(block, true)), block.rest, solver,
                        executor, *block.elastic, load);
    euler.placement().origins = block.rest;
    euler.set_acceleration(Vector3<S>(S(random.uniform(-20, 20)), S(random.uniform(-20, 20)), S(-9.81)));
    DynamicState<S> state = euler.state();
    const double speed = log_uniform(1e-3, 1e2, random);
    for (S& v : state.velocities.reshaped()) {
        v = S(speed * random.normal());
    }
    euler.set_state(state);
    Matrix3X<S> d = Matrix3X<S>::Zero(3, block.rest.cols());
    Outcome worst;
    for (int step = 0; step < 4; ++step) {
        const Matrix3X<S> target =
            step == 1 ? random_boundary(block, random) : Matrix3X<S>(Matrix3X<S>::Zero(3, d.cols()));
        for (const std::int32_t v : block.top) {
            d.col(v) = target.col(v);
        }
        const SolveReport<S> report = euler.step(d);
        Outcome now = outcome(report, d);
        now.is_finite = now.is_finite && euler.state().positions.allFinite() && euler.state().velocities.allFinite();
        now.is_finite = now.is_finite && worst.is_finite;
        now.iterations = std::max(now.iterations, worst.iterations);
        if (!report.succeeded() || step == 0) {
            worst = now;
        }
        worst.is_finite = now.is_finite;
        worst.iterations = now.iterations;
    }
    return worst;
}

}  // namespace

template <class S>
void run_solves(Ledger& ledger, const SolveKind& kind, const BlockMaker<S>& make, long count, std::uint64_t seed) {
    const auto run = [&](const char* what, bool has_rest, bool must_recover, const auto& trial) {
        Tally& tally = ledger.begin(kind.name + ", " + what);
        tally.rest_tolerance = kind.rest_tolerance;
        tally.must_recover = has_rest && must_recover;
        for (long k = 0; k < count; ++k) {
            RandomGenerator random(seed + std::uint64_t(k));
            tally.attempt([&] { return trial(random); });
        }
        ledger.print_last();
    };
    run("boundary turned inside out and back", true, kind.recovers, [&](RandomGenerator& random) {
        const Tissue tissue = random_tissue(random);
        return there_and_back(make(Shape::regular, tissue, random), random);
    });
    run("loaded and released", true, kind.recovers, [&](RandomGenerator& random) {
        const Tissue tissue = random_tissue(random);
        return loaded_and_released(make(Shape::regular, tissue, random), tissue, 0.3, random);
    });
    run("overloaded and released", true, kind.recovers, [&](RandomGenerator& random) {
        const Tissue tissue = random_tissue(random);
        return loaded_and_released(make(Shape::regular, tissue, random), tissue, 100, random);
    });
    run("slivers, slender and thin cells", true, false, [&](RandomGenerator& random) {
        const Tissue tissue = random_tissue(random);
        const Shape shape = Shape(1 + random.index(3));
        return there_and_back(make(shape, tissue, random), random);
    });
    run("time steps of 1e-5 to 1 s", false, false, [&](RandomGenerator& random) {
        const Tissue tissue = random_tissue(random);
        const Shape shape = random.uniform() < 0.5 ? Shape::regular : Shape(1 + random.index(3));
        return stepped(make(shape, tissue, random), random);
    });
}

template void run_solves(Ledger&, const SolveKind&, const BlockMaker<float>&, long, std::uint64_t);
template void run_solves(Ledger&, const SolveKind&, const BlockMaker<double>&, long, std::uint64_t);

}  // namespace reliability
