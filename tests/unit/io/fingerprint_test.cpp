// SPDX-License-Identifier: MIT
#include <softtissue/io/fingerprint.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("the values of FNV-1a") {
    CHECK(Fingerprint().text() == "cbf29ce484222325");
    CHECK(Fingerprint().add_bytes("a", 1).text() == "af63dc4c8601ec8c");
    CHECK(Fingerprint().add_bytes("foobar", 6).text() == "85944171f73967e8");
}

TEST_CASE("contents that differ in any number differ; the same content is the same") {
    Motion<double> motion{{Pose<double>::rest(2), Pose<double>::rest(2)}, 30.0};
    const std::string before = Fingerprint().add(motion).text();
    CHECK(Fingerprint().add(motion).text() == before);
    motion.poses[1].rotation_vectors(2, 1) = 1e-300;
    CHECK(Fingerprint().add(motion).text() != before);
    motion.poses[1].rotation_vectors(2, 1) = 0;
    motion.frame_rate = 60;
    CHECK(Fingerprint().add(motion).text() != before);
    CHECK(Fingerprint().add("ab").add("c").text() != Fingerprint().add("a").add("bc").text());
}

TEST_CASE("a body is told by shape, weights and regressor") {
    SmplBody<double> body;
    body.template_vertices = Matrix3X<double>::Random(3, 4);
    body.shape_directions = MatrixX<double>::Random(12, 2);
    body.joint_regressor.resize(1, 4);
    body.joint_regressor.insert(0, 1) = 1.0;
    body.weights = SkinningWeights<double>(MatrixX<double>::Ones(4, 1));
    const std::string before = Fingerprint().add(body).text();
    CHECK(Fingerprint().add(SmplBody<double>(body)).text() == before);
    SmplBody<double> other = body;
    other.joint_regressor.coeffRef(0, 1) = 0.5;
    CHECK(Fingerprint().add(other).text() != before);
    other = body;
    other.shape_directions(3, 1) += 1e-9;
    CHECK(Fingerprint().add(other).text() != before);
}
