// SPDX-License-Identifier: MIT
#include <softtissue/skinning/smpl_body.hpp>

#include "arm_body.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using softtissue_test::arm_body;

namespace {

/// The body that `spoil` has changed is refused with `text`.
template <class Spoil>
void check_refused(const Spoil& spoil, const char* text) {
    SmplBody<double> body = arm_body<double>(3);
    spoil(body);
    CHECK_THROWS_WITH_AS(body.validate("arm.npz"), text, InvalidInput);
}

}  // namespace

TEST_CASE_TEMPLATE("a body that fits together", S, float, double) {
    const SmplBody<S> body = arm_body<S>(3);
    CHECK(body.num_vertices() == 18);
    CHECK(body.num_joints() == 4);
    CHECK(body.num_shapes() == 2);
    CHECK_NOTHROW(body.validate("arm.npz"));
}

TEST_CASE("conversion to another precision and back keeps single-precision numbers") {
    const SmplBody<float> body = arm_body<float>(3);
    const SmplBody<double> wide = body.cast<double>();
    CHECK_NOTHROW(wide.validate("arm.npz"));
    CHECK(wide.template_vertices == body.template_vertices.cast<double>());
    CHECK(wide.shape_directions == body.shape_directions.cast<double>());
    const SmplBody<float> back = wide.cast<float>();
    CHECK((back.weights.dense() - body.weights.dense()).cwiseAbs().maxCoeff() <= 4 * std::numeric_limits<float>::epsilon());
    CHECK((back.pose_directions - body.pose_directions).norm() == 0);
    CHECK(back.tree == body.tree);
}

TEST_CASE("what does not fit is refused, with the name of the array") {
    using Body = SmplBody<double>;
    check_refused([](Body& b) { b.template_vertices.resize(3, 0); }, "arm.npz: v_template has no vertices");
    check_refused([](Body& b) { b.tree = KinematicTree({1, -1, 3, 1}); }, "arm.npz: the root is joint 1, expected 0");
    check_refused([](Body& b) { b.tree = KinematicTree({-1, 0}); }, "arm.npz: weights is 18 x 4, expected 18 x 2");
    check_refused([](Body& b) { b.joint_regressor.resize(4, 17); }, "arm.npz: J_regressor is 4 x 17, expected 4 x 18");
    check_refused([](Body& b) { b.shape_directions.resize(53, 2); },
                  "arm.npz: shapedirs (3n x shapes) is 53 x 2, expected 54 x 2");
    check_refused([](Body& b) { b.pose_directions.resize(54, 36); },
                  "arm.npz: posedirs (3n x 9(joints-1)) is 54 x 36, expected 54 x 27");
    check_refused([](Body& b) { b.joint_names = {"shoulder"}; }, "arm.npz: 1 joint names, expected 4");
    check_refused(
        [](Body& b) {
            b.faces.resize(3, 2);
            b.faces << 0, 1, 2, 3, 4, 18;
        },
        "arm.npz: f[1, 2] = 18, expected a vertex from 0 to 17");
}

TEST_CASE("values that are not finite are refused, with their place") {
    using Body = SmplBody<double>;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    check_refused([](Body& b) { b.template_vertices(1, 7) = nan; }, "arm.npz: v_template of vertex 7 is not finite");
    check_refused([](Body& b) { b.shape_directions(31, 1) = nan; }, "arm.npz: shapedirs of vertex 10 is not finite");
    check_refused([](Body& b) { b.joint_regressor.coeffRef(0, 2) = nan; },
                  "arm.npz: J_regressor[0, 2] = nan, expected a finite value");
    check_refused([](Body& b) { b.pose_directions.coeffRef(5, 3) = nan; },
                  "arm.npz: posedirs[5, 3] = nan, expected a finite value");
}
