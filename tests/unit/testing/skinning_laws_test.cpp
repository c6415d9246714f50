// SPDX-License-Identifier: MIT
#include <softtissue/testing/skinning_laws.hpp>

#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include "../skinning/arm_body.hpp"

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// Linear blending with one thing wrong.
template <class Change>
struct Broken : LinearBlend<double> {
    AffineTransform<double> blend(const MatrixX<double>& prepared, std::span<const JointWeight<double>> row) const {
        return Change::apply(LinearBlend<double>::blend(prepared, row), prepared, row);
    }
};

using Row = std::span<const JointWeight<double>>;

struct Nothing {
    static AffineTransform<double> apply(AffineTransform<double> T, const MatrixX<double>&, Row) { return T; }
};
struct Grown {
    static AffineTransform<double> apply(AffineTransform<double> T, const MatrixX<double>&, Row) {
        T.linear *= 1.001;
        return T;
    }
};
struct FirstJointCountsMore {
    static AffineTransform<double> apply(AffineTransform<double> T, const MatrixX<double>& prepared, Row row) {
        T.translation += 0.01 * (prepared.col(row.front().joint).tail<3>() - T.translation);
        return T;
    }
};
struct PullsToTheOrigin {
    static AffineTransform<double> apply(AffineTransform<double> T, const MatrixX<double>&, Row) {
        T.translation *= 0.99;
        return T;
    }
};

/// Quaternions blended without aligning their signs.
struct Unaligned : DualQuaternion<double> {
    AffineTransform<double> blend(const MatrixX<double>& prepared, Row row) const {
        MatrixX<double> tampered = prepared;
        for (Index j = 0; j < prepared.cols(); ++j) {
            if (prepared(1, j) < 0) {  // a sign that depends on the rotation, as from an unlucky conversion
                tampered.col(j) *= -1;
            }
        }
        Eigen::Matrix<double, 8, 1> sum = Eigen::Matrix<double, 8, 1>::Zero();
        for (const auto& [joint, weight] : row) {
            sum += weight * tampered.col(joint).head<8>();
        }
        MatrixX<double> one(9, 1);
        one << sum / sum.head<4>().norm(), 1;  // a joint agrees with itself
        const std::vector<JointWeight<double>> alone{{0, 1.0}};
        return DualQuaternion<double>::blend(one, alone);
    }
};

/// A body that moves its vertices before skinning.
struct BrokenBody {
    using Scalar = double;
    VolumetricSmpl<double> body{softtissue_test::arm_body<double>()};

    const Matrix3X<double>& rest_vertices() const { return body.rest_vertices(); }
    const Matrix3X<double>& rest_joints() const { return body.rest_joints(); }
    const KinematicTree& tree() const { return body.tree(); }
    Index num_joints() const { return body.num_joints(); }
    PosedBody<double> pose(const Pose<double>& pose) const {
        PosedBody<double> result = body.pose(pose);
        result.positions.row(0).array() += 1e-3;
        return result;
    }
};

}  // namespace

TEST_CASE("what is right passes, and every law is measured") {
    const LawReport report = check_skinning_laws(Broken<Nothing>{});
    CHECK_MESSAGE(report.all_passed(), report.summary());
    for (const char* law : {"identity", "common motion", "single joint", "rigid equivariance", "weight permutation",
                            "quaternion sign", "inverse"}) {
        CHECK(report.has(law));
    }
    CHECK_FALSE(report.has("rigid"));
}

TEST_CASE("each mistake breaks its law") {
    CHECK_FALSE(check_skinning_laws(Broken<Grown>{})["identity"].passed);
    CHECK_FALSE(check_skinning_laws(Broken<FirstJointCountsMore>{})["weight permutation"].passed);
    CHECK_FALSE(check_skinning_laws(Broken<PullsToTheOrigin>{})["common motion"].passed);
    CHECK_FALSE(check_skinning_laws(Broken<PullsToTheOrigin>{})["rigid equivariance"].passed);
    CHECK_FALSE(check_skinning_laws(Broken<PullsToTheOrigin>{})["single joint"].passed);
    CHECK_FALSE(check_skinning_laws(LinearBlend<double>{}, {.is_rigid = true})["rigid"].passed);
    CHECK_FALSE(check_skinning_laws(Unaligned{})["rigid equivariance"].passed);
}

TEST_CASE("a body that leaves its place breaks the body laws") {
    const LawReport report = check_skinned_body_laws(BrokenBody{}, {.samples = 3});
    CHECK_FALSE(report["identity pose"].passed);
    CHECK_FALSE(report["skinning relation"].passed);
    CHECK_FALSE(report["inverse skinning"].passed);
    CHECK_FALSE(report["rigid body"].passed);
}
