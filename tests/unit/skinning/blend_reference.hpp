// SPDX-License-Identifier: MIT
/// @file
/// The cases of o7_{moderate,large}.npz: points skinned by an independent program.
#pragma once

#include <softtissue/io/npz.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/weights.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

inline const std::vector<std::string> blend_reference_names{"o7_moderate", "o7_large"};

inline std::filesystem::path blend_reference_path(const std::string& name) {
    return std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "reference" / (name + ".npz");
}

struct BlendReference {
    std::vector<AffineTransform<double>> joints;
    SkinningWeights<double> weights;
    Matrix3X<double> points;
    NpzFile file;

    explicit BlendReference(const std::string& name) : file(read_npz(blend_reference_path(name))) {
        for (const Eigen::Matrix4d& T : file.at("skin_T").matrices<double, 4, 4>()) {
            joints.push_back({T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()});
        }
        weights = SkinningWeights<double>(file.at("W").matrix<double>());
        points = file.at("v").columns3<double>();
    }

    /// The points under a policy, and the largest distance to the array `expected` [m].
    template <class Policy>
    double largest_error(const Policy& policy, const std::string& expected) const {
        const Matrix3X<double> reference = file.at(expected).columns3<double>();
        MatrixX<double> prepared;
        policy.prepare_into(joints, prepared);
        double worst = 0;
        for (Index v = 0; v < points.cols(); ++v) {
            const Vector3<double> x = policy.blend(prepared, weights.row(v))(points.col(v));
            worst = std::max(worst, (x - reference.col(v)).norm());
        }
        return worst;
    }
};

}  // namespace softtissue_test
