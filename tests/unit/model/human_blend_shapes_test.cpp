// SPDX-License-Identifier: MIT
#include <softtissue/model/human_blend_shapes.hpp>

#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/model/human_skinning.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace softtissue;

namespace {

struct Shaped {
    HumanMesh mesh = make_human_mesh();
    HumanBlendShapes shapes{human_rest_joints()};
    MatrixX<double> directions = shapes.displacement(mesh, HumanSkinning(human_rest_joints()).weights(mesh));

    Matrix3X<double> with(const VectorX<double>& betas) const {
        const VectorX<double> d = directions * betas;
        return mesh.vertices + Eigen::Map<const Matrix3X<double>>(d.data(), 3, mesh.num_vertices());
    }
    double volume(Index shape, double beta) const {
        return enclosed_volume(with(beta * VectorX<double>::Unit(10, shape)), mesh.faces);
    }
    double height(Index shape, double beta) const {
        const Matrix3X<double> x = with(beta * VectorX<double>::Unit(10, shape));
        return x.row(1).maxCoeff() - x.row(1).minCoeff();
    }
};

const Shaped& shaped() {
    static const Shaped result;
    return result;
}

/// No triangle turns by more than 25 degrees or keeps less than half its area.
void check_sound(const Matrix3X<double>& x) {
    const HumanMesh& mesh = shaped().mesh;
    const Matrix3X<double> before = area_vectors(mesh.vertices, mesh.faces);
    const Matrix3X<double> after = area_vectors(x, mesh.faces);
    double least_cosine = 1.0;
    double least_area = 1.0;
    for (Index f = 0; f < before.cols(); ++f) {
        least_cosine = std::min(least_cosine, before.col(f).normalized().dot(after.col(f).normalized()));
        least_area = std::min(least_area, after.col(f).norm() / before.col(f).norm());
    }
    CHECK(least_cosine > 0.9);
    CHECK(least_area > 0.5);
    CHECK(crossing_triangles(x, mesh.faces).empty());
}

}  // namespace

TEST_CASE("human blend shapes: +-2 along each direction stays a sound body") {
    for (Index k = 0; k < HumanBlendShapes::num_shapes; ++k) {
        for (const double beta : {-2.0, 2.0}) {
            CAPTURE(k);
            CAPTURE(beta);
            check_sound(shaped().with(beta * VectorX<double>::Unit(10, k)));
        }
    }
}

TEST_CASE("human blend shapes: all directions at once, at +-1, stay a sound body") {
    for (unsigned pattern = 0; pattern < 6; ++pattern) {
        VectorX<double> betas(10);
        for (Index k = 0; k < 10; ++k) {
            betas(k) = ((pattern * 2654435761u) >> (20 + k)) % 2 == 0 ? -1.0 : 1.0;
        }
        CAPTURE(pattern);
        check_sound(shaped().with(betas));
    }
}

TEST_CASE("human blend shapes: each does what its name says") {
    using H = HumanBlendShapes;
    const Shaped& s = shaped();
    const double volume = s.volume(0, 0.0);
    const double height = s.height(0, 0.0);
    CHECK(s.height(H::size, 1.0) == doctest::Approx(1.035 * height));
    CHECK(s.volume(H::size, 1.0) == doctest::Approx(1.035 * 1.035 * 1.035 * volume));
    CHECK(s.volume(H::mass, 1.0) > 1.08 * volume);
    CHECK(s.height(H::mass, 1.0) < 1.005 * height);
    CHECK(s.height(H::leg_length, 1.0) > height + 0.01);
    for (const Index k : {H::belly, H::hips, H::chest, H::muscle}) {
        CHECK(s.volume(k, 1.0) > 1.005 * volume);
        CHECK(s.height(k, 1.0) == doctest::Approx(height).epsilon(1e-4));
    }
    const Matrix3X<double> arms = s.shapes.joint_displacement(H::arm_length);
    CHECK(arms.col(human_joint::hand).norm() > 0.015);
    CHECK(arms.col(human_joint::knee).norm() == 0.0);
    CHECK(s.shapes.joint_displacement(H::shoulder_width)(0, human_joint::shoulder) > 0.005);
}

TEST_CASE("human blend shapes: directions and joints are mirror symmetric") {
    const Shaped& s = shaped();
    for (Index k = 0; k < HumanBlendShapes::num_shapes; ++k) {
        double worst = 0.0;
        for (Index v = 0; v < s.mesh.num_vertices(); ++v) {
            const Vector3<double> a = s.directions.col(k).segment<3>(3 * v);
            const Vector3<double> b = s.directions.col(k).segment<3>(3 * s.mesh.mirror[size_t(v)]);
            worst = std::max(worst, (a - mirrored(b)).norm());
        }
        CHECK(worst < 1e-14);  // sums in another order
        const Matrix3X<double> m = s.shapes.joint_displacement(k);
        for (Index j = 0; j < m.cols(); ++j) {
            CHECK((m.col(j) - mirrored(m.col(mirror_joint(j)))).norm() < 1e-15);
        }
    }
}

TEST_CASE("human blend shapes: no two directions are alike") {
    const MatrixX<double>& d = shaped().directions;
    for (Index k = 0; k < d.cols(); ++k) {
        CHECK(d.col(k).norm() > 0.0);
        for (Index l = 0; l < k; ++l) {
            CHECK(std::abs(d.col(k).dot(d.col(l))) < 0.98 * d.col(k).norm() * d.col(l).norm());
        }
    }
}
