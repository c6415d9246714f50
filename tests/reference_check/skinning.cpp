// SPDX-License-Identifier: MIT
// Blends of joint transforms, and whole bodies against an independent implementation of SMPL's function.
#include "reference_case.hpp"

#include <softtissue/io/smpl_file.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double point_tolerance = 1e-10;  // [m]
constexpr double body_tolerance = 1e-8;    // [m]; the reference adds 1e-8 inside a norm

std::vector<AffineTransform<double>> stored_transforms(const NpyArray& array) {
    std::vector<AffineTransform<double>> transforms;
    for (const Eigen::Matrix4d& T : array.matrices<double, 4, 4>()) {
        transforms.push_back({T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()});
    }
    return transforms;
}

template <class Policy>
std::vector<AffineTransform<double>> blended(const Policy& policy, const std::vector<AffineTransform<double>>& joints,
                                             const SkinningWeights<double>& weights) {
    MatrixX<double> prepared;
    policy.prepare_into(joints, prepared);
    std::vector<AffineTransform<double>> transforms;
    for (Index v = 0; v < weights.num_vertices(); ++v) {
        transforms.push_back(policy.blend(prepared, weights.row(v)));
    }
    return transforms;
}

/// Largest distance between transformed and stored points.
double point_error(const std::vector<AffineTransform<double>>& transforms, const Matrix3X<double>& rest,
                   const Matrix3X<double>& expected) {
    double worst = 0.0;
    for (size_t v = 0; v < transforms.size(); ++v) {
        worst = std::max(worst, (transforms[v](rest.col(Index(v))) - expected.col(Index(v))).norm());
    }
    return worst;
}

void check_body(const std::string& size, const NpzFile& reference, const std::filesystem::path& bodies, Checklist& checks) {
    const SmplBody<double> body = read_smpl_body<double>(bodies / ("body_" + size + ".npz"));
    VolumetricSmpl<double> model(body);
    const MatrixX<double> poses = reference.at(size + "_poses").matrix<double>();
    const MatrixX<double> betas = reference.at(size + "_betas").matrix<double>();
    const MatrixX<double> translations = reference.at(size + "_trans").matrix<double>();
    const std::vector<double> vertices = reference.at(size + "_vertices").as<double>();
    const std::vector<double> joints = reference.at(size + "_joints").as<double>();
    const Index n = model.num_vertices();
    const Index num_joints = model.num_joints();
    double vertex_error = 0.0, joint_error = 0.0;
    for (Index k = 0; k < poses.rows(); ++k) {
        Pose<double> pose = Pose<double>::rest(num_joints);
        for (Index j = 0; j < num_joints; ++j) {
            pose.rotation_vectors.col(j) = poses.row(k).segment<3>(3 * j).transpose();
        }
        pose.translation = translations.row(k).transpose();
        model.set_shape(betas.row(k).transpose());
        const PosedBody<double> posed = model.pose(pose);
        const Eigen::Map<const Matrix3X<double>> expected(vertices.data() + 3 * n * k, 3, n);
        vertex_error = std::max(vertex_error, (posed.positions - expected).colwise().norm().maxCoeff());
        for (Index j = 0; j < num_joints; ++j) {
            const Eigen::Map<const Vector3<double>> joint(joints.data() + 3 * (num_joints * k + j));
            joint_error = std::max(joint_error,
                                   (posed.joint_transforms[size_t(j)](model.rest_joints().col(j)) - joint).norm());
        }
    }
    checks.add("body_" + size, "vertices [m]", vertex_error, body_tolerance);
    checks.add("body_" + size, "joints [m]", joint_error, body_tolerance);
}

}  // namespace

void check_skinning(const ReferenceCase& reference, Checklist& checks) {
    const std::vector<AffineTransform<double>> joints = stored_transforms(reference.file.at("skin_T"));
    const SkinningWeights<double> weights(reference.file.at("W").matrix<double>());
    const Matrix3X<double> rest = reference.points("v");

    const std::vector<AffineTransform<double>> linear = blended(LinearBlend<double>(), joints, weights);
    const std::vector<AffineTransform<double>> linear_expected = stored_transforms(reference.file.at("lbs_T"));
    const auto polar_expected = reference.file.at("lbs_polar_R").matrices<double, 3, 3>();
    const std::vector<AffineTransform<double>> dual = blended(DualQuaternion<double>(), joints, weights);
    const auto rotation_expected = reference.file.at("dqs_R").matrices<double, 3, 3>();
    double map_error = 0.0, polar_error = 0.0, rotation_error = 0.0;
    for (size_t v = 0; v < linear.size(); ++v) {
        map_error = std::max(map_error, relative_difference(linear[v].linear, linear_expected[v].linear, 1.0));
        polar_error = std::max(polar_error, relative_difference(polar_rotation(linear[v].linear), polar_expected[v], 1.0));
        rotation_error = std::max(rotation_error, relative_difference(dual[v].linear, rotation_expected[v], 1.0));
    }
    checks.add(reference.name, "linear blend, points [m]", point_error(linear, rest, reference.points("lbs")), point_tolerance);
    checks.add(reference.name, "linear blend, maps", map_error, point_tolerance);
    checks.add(reference.name, "linear blend, polar rotations", polar_error, point_tolerance);
    checks.add(reference.name, "dual quaternions, points [m]", point_error(dual, rest, reference.points("dqs")),
               point_tolerance);
    checks.add(reference.name, "dual quaternions, rotations", rotation_error, point_tolerance);
}

void check_smpl_bodies(const std::filesystem::path& reference, const std::filesystem::path& bodies, Checklist& checks) {
    const NpzFile file = read_npz(reference);
    for (const char* size : {"small", "full"}) {
        if (file.contains(std::string(size) + "_poses")) {
            check_body(size, file, bodies, checks);
        }
    }
}

}  // namespace reference_check
