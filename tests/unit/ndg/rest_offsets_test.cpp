// SPDX-License-Identifier: MIT
#include <softtissue/ndg/rest_offsets.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("positions -> offsets -> positions", S, float, double) {
    const LayeredLimb<S> limb;
    const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
    const auto transforms = limb.transforms(1.1);
    RandomGenerator random(2);
    Matrix3X<S> x = limb.bent(1.1);
    VectorX<S> offsets(3 * prescribed.num_free());
    const S tolerance = S(20) * std::numeric_limits<S>::epsilon();
    SUBCASE("what skinning reaches needs no offset") {
        CHECK(rest_offsets_into<S, S>(limb.body, prescribed, transforms, x, offsets) == 0);
        CHECK(offsets.cwiseAbs().maxCoeff() < tolerance);
    }
    SUBCASE("the way back ends where it began") {
        for (const std::int32_t v : prescribed.free_vertices()) {
            x.col(v) += S(0.01) * random_normal<Vector3<S>>(random);
        }
        CHECK(rest_offsets_into<S, S>(limb.body, prescribed, transforms, x, offsets) == 0);
        CHECK(offsets.cwiseAbs().maxCoeff() > S(0.01));
        Matrix3X<S> found = limb.bent(1.1);
        move_by_rest_offsets<S, S>(limb.body, prescribed, transforms, offsets, found);
        CHECK((found - x).cwiseAbs().maxCoeff() < tolerance);
        const ThreadExecutor threads(3);
        VectorX<S> again(offsets.size());
        rest_offsets_into<S, S>(limb.body, prescribed, transforms, x, again, threads);
        CHECK(again == offsets);
        Matrix3X<S> found_again = limb.bent(1.1);
        move_by_rest_offsets<S, S>(limb.body, prescribed, transforms, offsets, found_again, threads);
        CHECK(found_again == found);
    }
}

TEST_CASE("a turn of everything does not change the offsets") {
    const LayeredLimb<double> limb;
    const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
    auto transforms = limb.transforms(0.8);
    Matrix3X<double> x = 1.02 * limb.bent(0.8);
    VectorX<double> offsets(3 * prescribed.num_free()), turned(3 * prescribed.num_free());
    rest_offsets_into<double, double>(limb.body, prescribed, transforms, x, offsets);
    RandomGenerator random(3);
    const AffineTransform<double> turn{random_rotation<double>(random), Vector3<double>(1, 2, 3)};
    for (AffineTransform<double>& T : transforms) {
        T = turn * T;
    }
    x = (turn.linear * x).colwise() + turn.translation;
    rest_offsets_into<double, double>(limb.body, prescribed, transforms, x, turned);
    CHECK((offsets - turned).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a vertex half with each of two opposite bones has no inverse: it gets 0 and is counted") {
    LayeredLimb<double> limb;
    const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
    const Index flat = 70;
    MatrixX<double> weights = limb.body.weights.dense();
    weights.row(prescribed.free_vertices()[flat]).setConstant(0.5);
    limb.body.weights = SkinningWeights<double>(weights);
    std::vector<AffineTransform<double>> transforms(2);
    transforms[1].linear = Vector3<double>(1, -1, -1).asDiagonal();
    const Matrix3X<double> x = limb.body.mesh.rest_positions.array() + 0.01;
    VectorX<double> offsets(3 * prescribed.num_free());
    CHECK(rest_offsets_into<double, double>(limb.body, prescribed, transforms, x, offsets) == 1);
    for (Index k = 0; k < prescribed.num_free(); ++k) {
        CHECK(offsets.segment<3>(3 * k).isZero(0) == (k == flat));
    }
}

TEST_CASE("arrays of another body are refused") {
    const LayeredLimb<double> limb;
    const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
    const auto transforms = limb.transforms(0.1);
    VectorX<double> offsets(3 * prescribed.num_free()), small(3);
    Matrix3X<double> x = limb.body.mesh.rest_positions;
    CHECK_THROWS_WITH_AS((rest_offsets_into<double, double>(limb.body, prescribed, transforms, x, small)),
                         "rest offsets: 3 numbers, expected three for each of 160 free vertices", InvalidInput);
    CHECK_THROWS_WITH_AS(
        (rest_offsets_into<double, double>(limb.body, PrescribedVertices(2, {}), transforms, x, offsets)),
        "rest offsets: 300 positions, prescribed ones of 2, expected 300", InvalidInput);
    x.resize(3, 299);
    CHECK_THROWS_WITH_AS((move_by_rest_offsets<double, double>(limb.body, prescribed, transforms, offsets, x)),
                         "rest offsets: 299 positions, prescribed ones of 300, expected 300", InvalidInput);
}
