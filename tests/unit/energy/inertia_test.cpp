// SPDX-License-Identifier: MIT
#include <softtissue/energy/inertia.hpp>

#include <softtissue/energy/concepts.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace softtissue;

static_assert(EnergyTerm<Inertia<float>>);

namespace {
constexpr double dt = 0.01;
const VectorX<double> masses = Eigen::Vector3d(2, 0, 3);
}  // namespace

TEST_CASE("energy, gradient and Hessian are those of m / (2 dt^2) |p + A d - xt|^2") {
    RandomGenerator random(1);
    using Columns = Eigen::Matrix<double, 3, 3>;
    Placement<double> placement{random_normal<Columns>(random), random_normal<Eigen::Matrix<double, 3, 9>>(random)};
    const Matrix3X<double> target = random_normal<Columns>(random), d = random_normal<Columns>(random);
    const SequentialExecutor executor;
    for (const bool with_maps : {true, false}) {
        CAPTURE(with_maps);
        if (!with_maps) {
            placement.maps.resize(3, 0);
        }
        Inertia<double> inertia(masses, dt);
        inertia.set_step(placement, target);
        const std::array<std::int32_t, 1> held{1};
        const PrescribedVertices prescribed(3, held);
        BlockMatrix<double> hessian{BlockPattern({{1}, {0}})};
        inertia.bind(prescribed, hessian.pattern());
        inertia.add_hessian(d, PsdFilter::none, hessian, executor);
        Matrix3X<double> gradient = Matrix3X<double>::Zero(3, 3);
        inertia.add_gradient(d, gradient, executor);

        double energy = 0;
        for (Index v = 0; v < 3; ++v) {
            Matrix3<double> A = Matrix3<double>::Identity();
            if (with_maps) {
                A = placement.maps.middleCols<3>(3 * v);
            }
            const Vector3<double> offset = placement.origins.col(v) + A * d.col(v) - target.col(v);
            energy += 0.5 * masses(v) * offset.squaredNorm() / (dt * dt);
            const Vector3<double> expected = masses(v) * A.transpose() * offset / (dt * dt);
            CHECK((gradient.col(v) - expected).norm() <= 1e-14 * expected.norm());
            const std::int32_t j = prescribed.free_index(v);
            if (j != PrescribedVertices::prescribed) {
                const Matrix3<double> block = masses(v) * A.transpose() * A / (dt * dt);
                CHECK((hessian.matrix().toDense().block<3, 3>(3 * j, 3 * j) - block).norm() <= 1e-14 * block.norm());
            }
        }
        CHECK(inertia.energy(d, executor) == doctest::Approx(energy).epsilon(1e-14));
        CHECK(hessian.matrix().toDense().block<3, 3>(0, 3).norm() == 0.0);
    }
}

TEST_CASE("a displacement keeps its digits far from the origin") {
    Placement<double> placement{Matrix3X<double>::Constant(3, 1, 1e3), {}};
    const Matrix3X<double> target = placement.origins;
    Inertia<double> inertia(Eigen::Matrix<double, 1, 1>(1.0), 1.0);
    inertia.set_step(placement, target);
    const Matrix3X<double> d = Matrix3X<double>::Constant(3, 1, 1.0 / 3.0 * 1e-9);
    CHECK(inertia.energy(d, SequentialExecutor{}) == doctest::Approx(0.5 * d.squaredNorm()).epsilon(1e-14));
}

TEST_CASE("a time step or masses that make no sense are refused") {
    CHECK_THROWS_WITH_AS(Inertia<double>(masses, 0.0), "time step = 0 s, expected > 0", InvalidInput);
    CHECK_THROWS_AS(Inertia<double>(masses, std::numeric_limits<double>::quiet_NaN()), InvalidInput);
    CHECK_THROWS_WITH_AS(Inertia<double>(masses, 1e-200),
                         "time step = 1e-200 s, expected a square within the range of the numbers", InvalidInput);
    CHECK_THROWS_AS(Inertia<double>(masses, 1e200), InvalidInput);
    CHECK_THROWS_WITH_AS(Inertia<double>(Eigen::Vector2d(1, -2), dt), "mass of vertex 1 = -2 kg, expected >= 0",
                         InvalidInput);
    CHECK_THROWS_AS(Inertia<double>(Eigen::Vector2d(std::numeric_limits<double>::infinity(), 1), dt), InvalidInput);
}
