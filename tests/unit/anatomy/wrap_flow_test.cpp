// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/wrap_flow.hpp>

#include <softtissue/anatomy/skin_repair.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

template <class S>
struct FlowCapsule {
    CapsuleBody<S> capsule;
    TriangleMesh mesh{capsule.faces, capsule.positions.cols()};
    Matrix3X<S> directions = repair_skin(mesh, capsule.positions).directions;

    /// The capsule with a smaller radius around the same axis.
    Matrix3X<S> shrunk(S factor) const {
        Matrix3X<S> points = capsule.positions;
        for (Index v = 0; v < points.cols(); ++v) {
            const Vector3<S> axis(S(0), std::clamp(points(1, v), S(0.1), S(0.9)), S(0));
            points.col(v) = axis + factor * (points.col(v) - axis);
        }
        return points;
    }

    Matrix3X<S> flow(const Matrix3X<S>& targets) const {
        return flow_to_targets<S>(mesh, capsule.positions, directions, targets);
    }

    S smallest_coefficient(const Matrix3X<S>& inner) const {
        const Matrix3X<S> inverse_sines = inverse_corner_sines(capsule.positions, capsule.faces);
        S smallest(1);
        for (Index t = 0; t < capsule.faces.cols(); ++t) {
            const Prism6::Nodes<S> X = nodes_between(capsule.faces, t, inner, capsule.positions);
            smallest = std::min(smallest, relative_coefficients<S>(X, inverse_sines.col(t)).minCoeff());
        }
        return smallest;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("targets that fit are reached", S, float, double) {
    const FlowCapsule<S> body;
    const Matrix3X<S> targets = body.shrunk(S(0.4));
    const Matrix3X<S> inner = body.flow(targets);
    CHECK((inner - targets).colwise().norm().maxCoeff() < S(2e-5));
    CHECK(body.smallest_coefficient(inner) >= S(0.2));
}

TEST_CASE_TEMPLATE("wild targets are approached without an invalid prism, always on the same way", S, float, double) {
    const FlowCapsule<S> body;
    RandomGenerator random(6);
    Matrix3X<S> targets = body.shrunk(S(0.4));
    for (S& value : targets.reshaped()) {
        value += S(0.02 * random.normal());
    }
    const Matrix3X<S> inner = body.flow(targets);
    CHECK(body.smallest_coefficient(inner) >= S(0.1999));
    // The noise exceeds the edges, most of it cannot be followed; the mean way can.
    CHECK((inner - targets).colwise().norm().mean() <
          S(0.6) * (body.capsule.positions - targets).colwise().norm().mean());
    CHECK(body.flow(targets) == inner);
}

TEST_CASE_TEMPLATE("below a sliver the start is shallower", S, float, double) {
    FlowCapsule<S> body;
    // Two vertices of a ring half a millimetre from each other.
    const std::int32_t a = CapsuleBody<S>::vertex(15, 0);
    const std::int32_t b = CapsuleBody<S>::vertex(15, 1);
    const Vector3<S> way = body.capsule.positions.col(b) - body.capsule.positions.col(a);
    body.capsule.positions.col(a) += way * (S(1) - S(0.0005) / way.norm());
    body.directions = -vertex_normals(body.capsule.positions, body.capsule.faces);
    CHECK(body.smallest_coefficient(body.flow(body.shrunk(S(0.6)))) >= S(0.1999));
}
