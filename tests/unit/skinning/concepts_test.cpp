// SPDX-License-Identifier: MIT
#include <softtissue/skinning/concepts.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// What a stranger writes: the vertex follows its heaviest joint.
struct HeaviestJoint {
    using Scalar = double;
    void prepare_into(std::span<const AffineTransform<double>> joints, MatrixX<double>& prepared) const {
        prepared.resize(12, Index(joints.size()));
        for (size_t j = 0; j < joints.size(); ++j) {
            prepared.col(Index(j)) << vec<double>(joints[j].linear), joints[j].translation;
        }
    }
    AffineTransform<double> blend(const MatrixX<double>& prepared, std::span<const JointWeight<double>> row) const {
        JointWeight<double> best = row.front();
        for (const JointWeight<double>& entry : row) {
            best = entry.weight > best.weight ? entry : best;
        }
        const Eigen::VectorXd column = prepared.col(best.joint);
        return {unvec<double>(column.head<9>()), column.tail<3>()};
    }
};

struct WithoutBlend {
    using Scalar = double;
    void prepare_into(std::span<const AffineTransform<double>>, MatrixX<double>&) const {}
};

/// Returns another type than the transform.
struct BlendsMatrices : WithoutBlend {
    Matrix3<double> blend(const MatrixX<double>&, std::span<const JointWeight<double>>) const { return {}; }
};

/// Changes itself while it blends.
struct NotConst : WithoutBlend {
    AffineTransform<double> blend(const MatrixX<double>&, std::span<const JointWeight<double>>) { return {}; }
};

}  // namespace

static_assert(SkinningPolicy<HeaviestJoint>);
static_assert(!SkinningPolicy<WithoutBlend>);
static_assert(!SkinningPolicy<BlendsMatrices>);
static_assert(!SkinningPolicy<NotConst>);
static_assert(!SkinningPolicy<int>);

TEST_CASE("a policy of one's own") {
    std::vector<AffineTransform<double>> joints(2);
    joints[1].translation << 1, 2, 3;
    MatrixX<double> prepared;
    const HeaviestJoint policy;
    policy.prepare_into(joints, prepared);
    const std::vector<JointWeight<double>> row{{0, 0.4}, {1, 0.6}};
    CHECK(policy.blend(prepared, row).translation == Vector3<double>(1, 2, 3));
}
