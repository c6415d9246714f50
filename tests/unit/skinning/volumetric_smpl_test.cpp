// SPDX-License-Identifier: MIT
#include <softtissue/skinning/volumetric_smpl.hpp>

#include "arm_body.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

using namespace softtissue;
using softtissue_test::arm_body;
using softtissue_test::random_pose;

namespace {

template <class S>
VectorX<S> two_betas() {
    return Eigen::Matrix<S, 2, 1>(S(0.7), S(-1.2));
}

/// The regressor's joints, 3 x joints.
template <class S>
Matrix3X<S> textbook_joints(const SmplBody<S>& body, const Matrix3X<S>& vertices) {
    const MatrixX<S> regressor = body.joint_regressor.toDense();
    Matrix3X<S> joints = Matrix3X<S>::Zero(3, body.num_joints());
    for (Index j = 0; j < joints.cols(); ++j) {
        for (Index v = 0; v < vertices.cols(); ++v) {
            joints.col(j) += regressor(j, v) * vertices.col(v);
        }
    }
    return joints;
}

/// SMPL, written down from its definition with dense arrays.
template <class S>
Matrix3X<S> textbook_lbs(const SmplBody<S>& body, const VectorX<S>& betas, const Pose<S>& pose) {
    const Index n = body.num_vertices(), joints = body.num_joints();
    const MatrixX<S> pose_directions = body.pose_directions.toDense(), weights = body.weights.dense();
    Matrix3X<S> rest = body.template_vertices;
    for (Index s = 0; s < betas.size(); ++s) {
        rest += betas(s) * body.shape_directions.col(s).reshaped(3, n);
    }
    Matrix3X<S> corrected = rest;
    for (Index j = 1; j < joints; ++j) {
        const Matrix3<S> R = rotation_matrix_from_rotation_vector<S>(pose.rotation_vectors.col(j));
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                corrected += (R(a, b) - S(a == b)) * pose_directions.col(9 * (j - 1) + 3 * a + b).reshaped(3, n);
            }
        }
    }
    const auto transforms = joint_transforms(body.tree, textbook_joints(body, rest), pose);
    Matrix3X<S> result = Matrix3X<S>::Zero(3, n);
    for (Index v = 0; v < n; ++v) {
        for (Index j = 0; j < joints; ++j) {
            result.col(v) += weights(v, j) * transforms[size_t(j)](corrected.col(v));
        }
    }
    return result;
}

template <class S>
S largest_distance(const Matrix3X<S>& a, const Matrix3X<S>& b) {
    return (a - b).colwise().norm().maxCoeff();
}

/// Extends rows known at the first six vertices of the arm to twelve: the others are means of neighbours.
template <class S>
MatrixX<S> means_of_neighbours(const MatrixX<S>& known) {
    MatrixX<S> result(12, known.cols());
    for (Index v = 0; v < 12; ++v) {
        result.row(v) = (known.row(v % 6) + known.row((v + 1) % 6)) / S(2);
    }
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("the SMPL function, against its definition", S, float, double) {
    const SmplBody<S> body = arm_body<S>();
    VolumetricSmpl model(body);
    model.set_shape(two_betas<S>());
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Pose<S> pose = random_pose<S>(4, seed, 3);
        const PosedBody<S> posed = model.pose(pose);
        // some 100 roundings of numbers up to 3
        const S tolerance = 100 * std::numeric_limits<S>::epsilon();
        CHECK(largest_distance(posed.positions, textbook_lbs(body, two_betas<S>(), pose)) <= tolerance);
        CHECK(posed.offsets == model.pose_offsets(pose));
        CHECK(posed.offsets.norm() > S(0.01));
        Matrix3X<S> relation(3, body.num_vertices());
        for (Index v = 0; v < body.num_vertices(); ++v) {
            relation.col(v) = posed.transforms[size_t(v)](model.rest_vertices().col(v) + posed.offsets.col(v));
        }
        CHECK(largest_distance(relation, posed.positions) <= 8 * std::numeric_limits<S>::epsilon());
        CHECK(largest_distance(unposed(posed, posed.positions), model.rest_vertices()) <= 10 * tolerance);
    }
}

TEST_CASE_TEMPLATE("shape: linear, joints follow the surface, missing coefficients are zero", S, float, double) {
    const SmplBody<S> body = arm_body<S>();
    VolumetricSmpl model(body);
    CHECK(model.rest_vertices() == body.template_vertices);
    CHECK(model.shape() == VectorX<S>::Zero(2));
    const Matrix3X<S> rest = model.rest_shape(two_betas<S>());
    CHECK(largest_distance(model.joints(two_betas<S>()), textbook_joints(body, rest)) <=
          10 * std::numeric_limits<S>::epsilon());
    const VectorX<S> one = VectorX<S>::Constant(1, S(2)), padded = Eigen::Matrix<S, 2, 1>(2, 0);
    CHECK(model.rest_shape(one) == model.rest_shape(padded));
    model.set_shape(two_betas<S>());
    CHECK(model.rest_vertices() == rest);
    CHECK(model.rest_joints() == model.joints(two_betas<S>()));
}

TEST_CASE("in another precision: the same body in the same shape, blended as asked") {
    VolumetricSmpl<double> model(arm_body<double>());
    model.set_shape(two_betas<double>());
    const Pose<double> pose = random_pose<double>(model.num_joints(), 5);
    const Pose<float> same_pose{pose.rotation_vectors.cast<float>(), pose.translation.cast<float>()};
    const VolumetricSmpl<float> single = model.cast<float>();
    CHECK(single.shape() == model.shape().cast<float>());
    CHECK((single.pose(same_pose).positions.cast<double>() - model.pose(pose).positions).cwiseAbs().maxCoeff() < 1e-5);
    const VolumetricSmpl<double, DualQuaternion<double>> rigid(arm_body<double>());
    CHECK(rigid.cast<double, DualQuaternion<double>>().pose(pose).positions == rigid.pose(pose).positions);
}

TEST_CASE("pose blend shapes: one rotation entry drives its own column") {
    SmplBody<double> body = arm_body<double>();
    MatrixX<double> directions = MatrixX<double>::Zero(3 * body.num_vertices(), 27);
    directions(3 * 5 + 2, 9 * 1 + 3 * 0 + 1) = 0.25;  // joint 2, (R - I)[0, 1], z of vertex 5
    body.pose_directions = directions.sparseView();
    const VolumetricSmpl model(body);
    Pose<double> pose = Pose<double>::rest(4);
    pose.rotation_vectors(2, 2) = 0.5;  // R[0, 1] = -sin 0.5
    const Matrix3X<double> offsets = model.pose_offsets(pose);
    CHECK(offsets(2, 5) == doctest::Approx(-0.25 * std::sin(0.5)).epsilon(1e-15));
    CHECK((offsets.array() != 0).count() == 1);
    pose = Pose<double>::rest(4);
    pose.rotation_vectors(2, 0) = 0.5;  // the root has none
    CHECK(model.pose_offsets(pose).isZero(0));
}

TEST_CASE("without correctives the offsets vanish; dual quaternions blend rigidly") {
    using S = double;
    const SmplBody<S> body = arm_body<S>();
    const Pose<S> pose = random_pose<S>(4, 3);
    const VolumetricSmpl<S> plain(body, {}, {.pose_correctives = false});
    CHECK(plain.pose(pose).offsets.isZero(S(0)));
    CHECK(plain.pose_offsets(pose).norm() > S(0.01));
    const VolumetricSmpl rigid(body, DualQuaternion<S>{});
    const PosedBody<S> posed = rigid.pose(pose);
    CHECK(posed.offsets.norm() > S(0.01));
    for (const AffineTransform<S>& T : posed.transforms) {
        CHECK(is_rotation(T.linear, 16 * std::numeric_limits<S>::epsilon()));
    }
}

TEST_CASE("posing again gives the same bits, in the same storage, on any number of threads") {
    const SmplBody<double> body = arm_body<double>(50);
    const VolumetricSmpl<double, DualQuaternion<double>> model(body);
    const Pose<double> first = random_pose<double>(4, 1), second = random_pose<double>(4, 2);
    const Matrix3X<double> expected = model.pose(first).positions;
    PosedBody<double> posed = model.pose(second);
    const double* const storage = posed.positions.data();
    CHECK(posed.positions != expected);
    for (const int threads : {1, 2, 7}) {
        const ThreadExecutor executor(threads);
        model.pose_into(second, posed, executor);
        model.pose_into(first, posed, executor);
        CHECK(posed.positions == expected);
        CHECK(posed.positions.data() == storage);
    }
}

TEST_CASE_TEMPLATE("carried into a volume: matched vertices move like the skin, bit for bit", S, float, double) {
    const SmplBody<S> body = arm_body<S>();
    VolumetricSmpl skin(body);
    skin.set_shape(two_betas<S>());
    std::vector<VertexMatch> matches;
    for (std::int32_t v = 0; v < 6; ++v) {
        matches.push_back({v, 10 + v});
    }
    Matrix3X<S> volume(3, 12);
    volume << skin.rest_vertices().middleCols(10, 6), S(0.5) * skin.rest_vertices().middleCols(10, 6);
    const VolumetricSmpl carried = skin.carried_into(volume, matches, means_of_neighbours<S>);

    CHECK(carried.num_vertices() == 12);
    CHECK(carried.rest_vertices() == volume);
    CHECK(carried.shape() == skin.shape());
    CHECK(carried.rest_joints() == skin.rest_joints());
    const VectorX<S> other_shape = VectorX<S>::Constant(2, S(-1));
    CHECK(carried.joints(other_shape) == skin.joints(other_shape));
    const Pose<S> pose = random_pose<S>(4, 9);
    CHECK(carried.pose(pose).positions.leftCols(6) == skin.pose(pose).positions.middleCols(10, 6));

    // Interpolated rows: means, up to what is dropped; with another shape the volume changes like the skin.
    const S tolerance = 10 * std::numeric_limits<S>::epsilon();
    const MatrixX<S> weights = skin.weights().dense();
    CHECK((carried.weights().dense().row(7) - (weights.row(11) + weights.row(12)) / S(2)).norm() <= tolerance);
    const Matrix3X<S> change = carried.rest_shape(other_shape) - volume;
    const Matrix3X<S> skin_change = skin.rest_shape(other_shape) - skin.rest_vertices();
    CHECK((change.col(1) - skin_change.col(11)).norm() <= tolerance);
    CHECK((change.col(7) - (skin_change.col(11) + skin_change.col(12)) / S(2)).norm() <= tolerance);
    const Matrix3X<S> offsets = carried.pose_offsets(pose), skin_offsets = skin.pose_offsets(pose);
    CHECK((offsets.col(7) - (skin_offsets.col(11) + skin_offsets.col(12)) / S(2)).norm() <= S(27 * 2 * 1e-6));
}

TEST_CASE("what does not fit is refused") {
    SmplBody<double> body = arm_body<double>();
    const VolumetricSmpl model(body);
    CHECK_THROWS_WITH_AS(model.rest_shape(VectorX<double>::Zero(3)), "shape has 3 coefficients, expected at most 2",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(model.pose(Pose<double>::rest(5)), "pose has 5 joints, expected 4", InvalidInput);
    CHECK_THROWS_WITH_AS(model.pose_offsets(Pose<double>::rest(5)), "pose has 5 joints, expected 4", InvalidInput);
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(model.rest_shape(Eigen::Vector2d(1, infinity)),
                         "shape: coefficient 1 = inf, expected a finite value", InvalidInput);
    CHECK_THROWS_WITH_AS(model.rest_shape(Eigen::Vector2d(1, std::numeric_limits<double>::max()) * 1e3),
                         "shape: coefficient 1 = inf, expected a finite value", InvalidInput);
    Pose<double> pose = Pose<double>::rest(4);
    pose.rotation_vectors(1, 3) = std::nan("");
    CHECK_THROWS_WITH_AS(model.pose(pose), "pose: joint 3: rotation is not finite", InvalidInput);
    CHECK_THROWS_WITH_AS(model.pose_offsets(pose), "pose: joint 3: rotation is not finite", InvalidInput);
    pose = Pose<double>::rest(4);
    pose.translation(2) = infinity;
    CHECK_THROWS_WITH_AS(model.pose(pose), "pose: translation is not finite", InvalidInput);
    body.shape_directions.resize(6, 2);
    CHECK_THROWS_WITH_AS(VolumetricSmpl{body}, "VolumetricSmpl: shapedirs (3n x shapes) is 6 x 2, expected 144 x 2",
                         InvalidInput);
}

TEST_CASE("agrees with smplx to 1e-8 m") {
    const std::filesystem::path folder = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data" / "body";
    if (!std::filesystem::exists(folder / "reference_lbs.npz")) {
        MESSAGE("skipped: " << (folder / "reference_lbs.npz").string() << " is not here");
        return;
    }
    const NpzFile cases = read_npz(folder / "reference_lbs.npz");
    for (const std::string name : {"small", "full"}) {
        VolumetricSmpl model(read_smpl_body<double>(folder / ("body_" + name + ".npz")));
        const MatrixX<double> poses = cases.at(name + "_poses").matrix<double>();
        const MatrixX<double> betas = cases.at(name + "_betas").matrix<double>();
        const Matrix3X<double> translations = cases.at(name + "_trans").columns3<double>();
        const std::vector<double> vertices = cases.at(name + "_vertices").as<double>();
        const std::vector<double> joints = cases.at(name + "_joints").as<double>();
        double worst = 0, worst_joint = 0;
        for (Index k = 0; k < poses.rows(); ++k) {
            const VectorX<double> flat = poses.row(k);
            Pose<double> pose{Eigen::Map<const Matrix3X<double>>(flat.data(), 3, 24), translations.col(k)};
            model.set_shape(betas.row(k).transpose());
            const PosedBody<double> posed = model.pose(pose);
            const Index n = model.num_vertices();
            const Eigen::Map<const Matrix3X<double>> expected(vertices.data() + 3 * n * k, 3, n);
            const Eigen::Map<const Matrix3X<double>> expected_joints(joints.data() + 3 * 24 * k, 3, 24);
            worst = std::max(worst, largest_distance<double>(posed.positions, expected));
            worst_joint = std::max(
                worst_joint,
                largest_distance<double>(posed_joints(posed.joint_transforms, model.rest_joints()), expected_joints));
        }
        MESSAGE(name << " body, " << poses.rows() << " cases: vertices within " << worst << " m, joints within "
                     << worst_joint << " m");
        CHECK(worst <= 1e-8);
        CHECK(worst_joint <= 1e-8);
    }
}
