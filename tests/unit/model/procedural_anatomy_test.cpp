// SPDX-License-Identifier: MIT
#include <softtissue/model/procedural_anatomy.hpp>

#include "tube_body.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
std::vector<AnatomyMesh<S>> anatomy_of(const TubeBody& body, double density = 0.75) {
    return procedural_anatomy<S>(body.joints.cast<S>(), body.bone.cast<S>(), body.muscle.cast<S>(), body.triangles,
                                 {.density = density});
}

}  // namespace

TEST_CASE_TEMPLATE("every surface is closed, faces outwards and has a name of its own", S, float, double) {
    std::map<std::string, AnatomyKind> kinds;
    Index vertices = 0;
    Index bones = 0;
    for (const AnatomyMesh<S>& mesh : anatomy_of<S>(tube_body())) {
        check_surface(mesh);
        CHECK(kinds.emplace(mesh.name, mesh.kind).second);
        vertices += mesh.positions.cols();
        bones += mesh.kind == AnatomyKind::bone ? 1 : 0;
    }
    CHECK(kinds.at("left_femur") == AnatomyKind::bone);
    CHECK(kinds.at("right_rib_12") == AnatomyKind::bone);
    CHECK(kinds.at("sacrum") == AnatomyKind::bone);
    CHECK(kinds.at("right_deltoid") == AnatomyKind::muscle);
    CHECK(bones == 67);
    CHECK(Index(kinds.size()) - bones == 88);
    CHECK(vertices > 20000);
    CHECK(vertices < 35000);
}

TEST_CASE("the right half mirrors the left") {
    std::map<std::string, AnatomyMesh<double>> meshes;
    for (AnatomyMesh<double>& mesh : anatomy_of<double>(tube_body())) {
        meshes.emplace(mesh.name, mesh);
    }
    Index pairs = 0;
    for (const auto& named : meshes) {
        const std::string& name = named.first;
        const AnatomyMesh<double>& left = named.second;
        if (name.rfind("left_", 0) == 0) {
            const AnatomyMesh<double>& right = meshes.at("right_" + name.substr(5));
            Matrix3X<double> image = left.positions;
            image.row(0) *= -1;
            CAPTURE(name);
            REQUIRE(image.cols() == right.positions.cols());
            // Rays that graze a triangle magnify the rounding of their origins.
            CHECK((image - right.positions).cwiseAbs().maxCoeff() < 1e-6);
            ++pairs;
        }
    }
    CHECK(pairs == 22 + 44);
}

TEST_CASE("density") {
    const auto count = [](double density) {
        Index vertices = 0;
        for (const AnatomyMesh<double>& mesh : anatomy_of<double>(tube_body(), density)) {
            check_surface(mesh);
            vertices += mesh.positions.cols();
        }
        return vertices;
    };
    CHECK(count(0.3) < count(0.75) / 2);
}

TEST_CASE("what cannot be a skeleton or a density is refused") {
    TubeBody body = tube_body();
    CHECK_THROWS_WITH_AS(anatomy_of<double>(body, 0.1), "procedural anatomy: density = 0.1, expected 0.3 to 10",
                         InvalidInput);
    body.joints(1, 3) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(anatomy_of<double>(body), InvalidInput);
    body.joints = body.joints.leftCols(22).eval();
    CHECK_THROWS_WITH_AS(anatomy_of<double>(body),
                         "procedural anatomy: 22 joint positions, expected SMPL's 24, all finite", InvalidInput);
    body = tube_body();
    body.muscle(0, 5) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(anatomy_of<double>(body), InvalidInput);
}
