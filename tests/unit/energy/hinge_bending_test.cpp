// SPDX-License-Identifier: MIT
#include <softtissue/energy/hinge_bending.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/energy/concepts.hpp>
#include <softtissue/energy/dihedral_chord.hpp>
#include <softtissue/energy/dihedral_difference.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <support/skin_sheet.hpp>
#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

static_assert(EnergyTerm<HingeBending<DihedralChord<float>>>);
static_assert(EnergyTerm<HingeBending<DihedralDifference<double>>>);
static_assert(HasConvexPart<DihedralChord<double>>);
static_assert(HasConvexPart<DihedralDifference<float>>);

#define EVERY_MEASURE DihedralChord<double>, DihedralDifference<double>, DihedralChord<float>, DihedralDifference<float>

TEST_CASE_TEMPLATE("the laws of an energy: derivatives, invariance, rest", Measure, EVERY_MEASURE) {
    using S = typename Measure::Scalar;
    const SkinSheet<S> sheet = bumpy_sheet<S>(3, 0.5);
    const Index n = sheet.positions.cols();
    RandomGenerator random(5);
    HingeBending<Measure> bending(sheet.surface, sheet.positions, S(0.7));
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(n, {}), executor, bending);
    const S epsilon = std::numeric_limits<S>::epsilon();

    // no energy and no stress at rest, but curvature
    const Matrix3X<S> zero = Matrix3X<S>::Zero(3, n);
    CHECK(objective.energy(zero) == S(0));
    CHECK(objective.full_gradient(zero).norm() == S(0));
    CHECK(std::abs(bending.angle(zero, 4)) > S(0.05));

    const Matrix3X<S> d = random_displacement<S>(n, 0.03, random);
    for (int sample = 0; sample < 3; ++sample) {
        const Matrix3X<S> D = random_displacement<S>(n, 0.05, random);
        const S slope = objective.full_gradient(d).cwiseProduct(D).sum();
        CHECK(taylor_rate([&](S h) { return objective.energy(d + h * D); }, slope).is_at_least(2));
        const VectorX<S> product = objective.hessian(d, PsdFilter::none).matrix() * VectorX<S>(D.reshaped());
        const Matrix3X<S> change = product.reshaped(3, n);
        CHECK(
            taylor_rate([&](S h) -> Matrix3X<S> { return objective.full_gradient(d + h * D); }, change).is_at_least(2));
    }

    const Matrix3<S> R = random_rotation<S>(random);
    const Matrix3X<S> moved = ((R * (sheet.positions + d)).colwise() + Vector3<S>(S(1), S(2), S(0))) - sheet.positions;
    const Matrix3X<S> forces = objective.full_gradient(d);
    CHECK(std::abs(objective.energy(moved) / objective.energy(d) - S(1)) < 1024 * epsilon);
    CHECK((objective.full_gradient(moved) - R * forces).norm() < 1024 * epsilon * forces.norm());
    CHECK(forces.rowwise().sum().norm() < 64 * epsilon * forces.cwiseAbs().sum());
}

TEST_CASE_TEMPLATE("filters are those of the 12x12 Hessian of a hinge", Measure, EVERY_MEASURE) {
    using S = typename Measure::Scalar;
    using Matrix12 = Eigen::Matrix<S, 12, 12>;
    const S tolerance = 256 * std::numeric_limits<S>::epsilon();
    RandomGenerator random(3);
    const SequentialExecutor executor;
    for (const double angle : {0.0, 0.6}) {
        const SkinSheet<S> sheet = single_hinge<S>(angle, 0.8, 0.3);
        HingeBending<Measure> bending(sheet.surface, sheet.positions, S(1));
        Objective objective(PrescribedVertices(4, {}), executor, bending);
        for (const double size : {0.0, 0.1, 0.4}) {
            const Matrix3X<S> d = random_displacement<S>(4, size, random);
            const Matrix12 H = objective.hessian(d, PsdFilter::none).matrix().toDense();
            for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
                const Matrix12 filtered_H = objective.hessian(d, filter).matrix().toDense();
                CHECK((filtered_H - filtered(H, filter)).norm() <= tolerance * H.norm());
                CHECK(symmetric_eigen(filtered_H).values.minCoeff() >= -tolerance * H.norm());
            }
            CHECK((symmetric_eigen(H).values.minCoeff() < S(-0.01) * H.norm()) == (size > 0));
        }
    }
}

TEST_CASE_TEMPLATE("the convex Hessian is at least the exact one, positive semi-definite, and equal to it at rest",
                   Measure, EVERY_MEASURE) {
    using S = typename Measure::Scalar;
    using Matrix12 = Eigen::Matrix<S, 12, 12>;
    const S tolerance = 512 * std::numeric_limits<S>::epsilon();
    RandomGenerator random(7);
    const SequentialExecutor executor;
    for (const double angle : {0.0, 0.6, -1.1}) {
        const SkinSheet<S> sheet = single_hinge<S>(angle, 0.8, 0.4);
        HingeBending<Measure> bending(sheet.surface, sheet.positions, S(1));
        Objective objective(PrescribedVertices(4, {}), executor, bending);
        BlockMatrix<S> convex(objective.hessian(Matrix3X<S>::Zero(3, 4), PsdFilter::none).pattern());
        for (const double size : {0.0, 1e-3, 0.05, 0.1, 0.15}) {
            for (int sample = 0; sample < 3; ++sample) {
                const Matrix3X<S> d = random_displacement<S>(4, size, random);
                const Matrix12 H = objective.hessian(d, PsdFilter::none).matrix().toDense();
                convex.set_zero();
                bending.add_convex_hessian(d, convex, executor);
                const Matrix12 C = convex.matrix().toDense();
                CHECK((C - C.transpose()).norm() <= tolerance * C.norm());
                CHECK(symmetric_eigen(C).values.minCoeff() >= -tolerance * C.norm());
                CHECK(symmetric_eigen(Matrix12(C - H)).values.minCoeff() >= -tolerance * C.norm());
                CHECK((C - H).norm() <= S(7 * size + 1e-5) * H.norm());
                // a direction of descent
                const Matrix3X<S> g = objective.full_gradient(d);
                CHECK(g.reshaped().dot(C * g.reshaped()) >= -tolerance * C.norm() * g.squaredNorm());
            }
        }
    }
}

TEST_CASE_TEMPLATE("the convex Hessian of collapsed and turned triangles and of a collapsed hinge is finite", S, float,
                   double) {
    using Matrix12 = Eigen::Matrix<S, 12, 12>;
    const SkinSheet<S> sheet = single_hinge<S>(0.3, 0.8, 0.3);
    HingeBending<DihedralChord<S>> bending(sheet.surface, sheet.positions, S(1));
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(4, {}), executor, bending);
    BlockMatrix<S> convex(objective.hessian(Matrix3X<S>::Zero(3, 4), PsdFilter::none).pattern());
    const S denormal = std::numeric_limits<S>::denorm_min();
    for (int kind = 0; kind < 6; ++kind) {
        Matrix3X<S> x = sheet.positions;
        if (kind == 0) {
            x.col(2) = x.col(0);  // without area
        } else if (kind == 1) {
            x.col(2) *= S(-1);  // turned over
        } else if (kind == 2) {
            x.col(1) = x.col(0);  // a hinge without length
        } else if (kind == 3) {
            x.setZero();
        } else if (kind == 4) {
            x.col(2) = S(0.1) * x.col(2) + S(0.4) * x.col(1);  // a sliver, below the threshold
        } else {
            x.col(2) = Vector3<S>(S(0.4), denormal, denormal);
        }
        convex.set_zero();
        bending.add_convex_hessian(x - sheet.positions, convex, executor);
        const Matrix12 C = convex.matrix().toDense();
        CAPTURE(kind);
        REQUIRE(C.allFinite());
        CHECK(symmetric_eigen(C).values.minCoeff() >= -512 * std::numeric_limits<S>::epsilon() * C.norm());
    }
}

TEST_CASE_TEMPLATE("a cylinder has the energy of a plate of rigidity 3 k, on any mesh", Measure, DihedralChord<double>,
                   DihedralDifference<double>) {
    const double k = 0.4, curvature = 0.5;
    for (const int n : {10, 20, 40}) {
        const SkinSheet<double> sheet = equilateral_sheet(n, 1.0 / n);
        HingeBending<Measure> bending(sheet.surface, sheet.positions, k);
        Matrix3X<double> d = -sheet.positions;
        for (Index v = 0; v < d.cols(); ++v) {
            const double along = curvature * sheet.positions(0, v);
            d.col(v) +=
                Vector3<double>(std::sin(along) / curvature, sheet.positions(1, v), (std::cos(along) - 1) / curvature);
        }
        const double area = std::sqrt(0.75);
        const double plate = 0.5 * (3 * k) * curvature * curvature * area;
        // n of n^2 hinges are missing in each of two directions, which hold 1/9 and 4/9 of the energy
        const double missing = 5.0 / 9.0 / n;
        const double relative_edge = curvature / n;
        CHECK(std::abs(bending.energy(d, SequentialExecutor{}) / plate - (1 - missing)) <
              relative_edge * relative_edge);
        // convex seen from above; edges at 60 degrees to the bending direction turn by 2 c L / sqrt(12)
        double largest = -1.0;
        for (Index h = 0; h < bending.num_hinges(); ++h) {
            largest = std::max(largest, bending.angle(d, h));
        }
        CHECK(largest == doctest::Approx(relative_edge / std::sqrt(3.0)).epsilon(relative_edge));
    }
}

TEST_CASE("one scale of lengths is as good as another in float") {
    const SkinSheet<float> unit = bumpy_sheet<float>(3, 1.0);
    const Matrix3X<float> small = 0x1p-10F * unit.positions;  // edges of a millimetre
    RandomGenerator random(8);
    const Matrix3X<float> d = random_displacement<float>(small.cols(), 0.2, random);
    HingeBending<DihedralChord<float>> large_bending(unit.surface, unit.positions, 1.0F);
    HingeBending<DihedralChord<float>> small_bending(unit.surface, small, 1.0F);
    const SequentialExecutor executor;
    CHECK(small_bending.energy(0x1p-10F * d, executor) ==
          doctest::Approx(double(large_bending.energy(d, executor))).epsilon(1e-5));
}

TEST_CASE_TEMPLATE("hinges share packs but no numbers; energy and gradient come together as they come alone", Measure,
                   EVERY_MEASURE) {
    using S = typename Measure::Scalar;
    const SkinSheet<S> sheet = bumpy_sheet<S>(3, 0.5);
    const Index n = sheet.positions.cols();
    RandomGenerator random(2);
    const Matrix3X<S> d = random_displacement<S>(n, 0.1, random);
    HingeBending<Measure> bending(sheet.surface, sheet.positions, S(0.7));
    REQUIRE(bending.num_hinges() % natural_lanes<S> != 0);
    const SequentialExecutor executor;
    Matrix3X<S> alone = Matrix3X<S>::Zero(3, n), together = alone, sum = alone;
    bending.add_gradient(d, alone, executor);
    const S epsilon = std::numeric_limits<S>::epsilon();
    const S energy = bending.energy(d, executor);
    CHECK(std::abs(bending.add_energy_and_gradient(d, together, executor) - energy) <= 16 * epsilon * energy);
    CHECK((together - alone).norm() <= 16 * epsilon * alone.norm());
    S energies(0);
    for (Index h = 0; h < bending.num_hinges(); ++h) {  // each hinge as a surface of its own
        Triangles triangles(3, 2);
        const auto at = bending.hinges().col(h);
        triangles << at(0), at(1), at(1), at(0), at(2), at(3);
        HingeBending<Measure> single(TriangleMesh(triangles, n), sheet.positions, S(0.7));
        energies += single.energy(d, executor);
        single.add_gradient(d, sum, executor);
    }
    CHECK(std::abs(energies - energy) <= 64 * epsilon * energy);
    CHECK((sum - alone).norm() <= 256 * epsilon * alone.norm());
}

TEST_CASE("the same bits for any number of threads; nothing is allocated after the first evaluation") {
    const SkinSheet<double> sheet = bumpy_sheet(10, 0.02);
    RandomGenerator random(6);
    const Index n = sheet.positions.cols();
    const Matrix3X<double> d = random_displacement<double>(n, 0.005, random);
    HingeBending<DihedralChord<double>> bending(sheet.surface, sheet.positions, 2e-3);
    const SequentialExecutor one;
    const ThreadExecutor three(3);
    Objective parallel(PrescribedVertices(n, {}), three, bending);
    Objective sequential(PrescribedVertices(n, {}), one, bending);
    CHECK(sequential.energy(d) == parallel.energy(d));
    CHECK(sequential.full_gradient(d) == parallel.full_gradient(d));
    CHECK(sequential.hessian(d, PsdFilter::clamp).matrix().toDense() ==
          parallel.hessian(d, PsdFilter::clamp).matrix().toDense());
    Eigen::internal::set_is_malloc_allowed(false);
    const double energy = sequential.energy(d);
    sequential.full_gradient(d);
    const BlockMatrix<double>& hessian = sequential.hessian(d, PsdFilter::clamp);
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(energy > 0.0);

    BlockMatrix<double> convex(hessian.pattern()), convex_parallel(hessian.pattern());
    bending.add_convex_hessian(d, convex_parallel, three);
    Eigen::internal::set_is_malloc_allowed(false);
    bending.add_convex_hessian(d, convex, one);
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(convex.matrix().coeffs().matrix() == convex_parallel.matrix().coeffs().matrix());
}

TEST_CASE("what does not fit is refused") {
    SkinSheet<double> sheet = single_hinge(0.0);
    using Bending = HingeBending<DihedralChord<double>>;
    CHECK_THROWS_WITH_AS(Bending(sheet.surface, sheet.positions, -1.0),
                         "hinge bending: stiffness = -1 J, expected >= 0", InvalidInput);
    CHECK_THROWS_WITH_AS(Bending(sheet.surface, Matrix3X<double>(Matrix3X<double>::Ones(3, 7)), 1.0),
                         "hinge bending: number of rest positions = 7, expected 4", InvalidInput);
    sheet.positions.col(2) = sheet.positions.col(0);
    CHECK_NOTHROW(Bending(sheet.surface, sheet.positions, 1.0));
    sheet.positions.col(1) = sheet.positions.col(0);
    CHECK_THROWS_WITH_AS(Bending(sheet.surface, sheet.positions, 1.0),
                         "hinge bending: edge (0, 1) has rest length 0 m, expected > 0", InvalidInput);
}
