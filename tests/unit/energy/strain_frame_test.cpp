// SPDX-License-Identifier: MIT
#include <softtissue/energy/strain_frame.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// A block, blended between two rigid motions along x, with small pose blend shapes.
template <class ElementType, class Policy>
struct SkinnedBlock {
    CellMesh<ElementType, double> mesh = solid_block<ElementType>({.n = 2, .noise = 0.05}).mesh;
    PosedBody<double> posed;
    Placement<double> skinned;
    Matrix3X<double> d;  // a random displacement

    SkinnedBlock() {
        RandomGenerator random(5);
        const Index n = mesh.num_vertices();
        const Policy policy;
        std::vector<AffineTransform<double>> joints(2);
        const double angle = 0.8;
        joints[1].linear = Matrix3<double>::Identity();
        joints[1].linear.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
        joints[1].translation << 0.1, -0.2, 0.3;
        joints[0].linear.setIdentity();
        joints[0].translation.setZero();
        MatrixX<double> weights(n, 2);
        for (Index v = 0; v < n; ++v) {
            const double w = std::min(std::max(mesh.rest_positions(0, v), 0.05), 0.95);
            weights.row(v) << 1 - w, w;
        }
        const SkinningWeights<double> sparse(weights);
        posed.resize(n, 2);
        posed.joint_transforms = joints;
        policy.prepare_into(posed.joint_transforms, posed.prepared_joints);
        posed.offsets = random_displacement<double>(n, 0.01, random);
        skinned.maps.resize(3, 3 * n);
        for (Index v = 0; v < n; ++v) {
            AffineTransform<double>& T = posed.transforms[size_t(v)];
            T = policy.blend(posed.prepared_joints, sparse.row(v));
            posed.positions.col(v) = T(mesh.rest_positions.col(v) + posed.offsets.col(v));
            skinned.maps.middleCols<3>(3 * v) = T.linear;
        }
        skinned.origins = posed.positions;
        d = random_displacement<double>(n, 0.03, random);
    }

    NodePositions<ElementType, double> nodes(const Matrix3X<double>& x, Index c) const {
        return mesh.gather(x, mesh.cells.col(c));
    }
};

template <class ElementType>
using Elastic = ElasticEnergy<ElementType, UniformField<Arap<double>>>;

}  // namespace

#define EVERY_BODY                                                                                              \
    SkinnedBlock<Tet4, LinearBlend<double>>, SkinnedBlock<Prism6, LinearBlend<double>>,                        \
        SkinnedBlock<Tet4, DualQuaternion<double>>, SkinnedBlock<Prism6, DualQuaternion<double>>

TEST_CASE_TEMPLATE("unposed: F is the gradient of P^-1 x on the rest shape", Body, EVERY_BODY) {
    const Body body;
    using E = typename decltype(body.mesh)::CellElement;
    Elastic<E> elastic(body.mesh, UniformField{Arap<double>()});
    Placement<double> placement;
    UnposedFrame::apply(body.mesh, body.skinned, elastic, placement);
    Matrix3X<double> x;
    placement.positions_into(body.d, x);
    const Matrix3X<double> u = unposed(body.posed, x);
    CHECK((u - body.mesh.rest_positions - body.d).cwiseAbs().maxCoeff() < 1e-13);
    for (Index c = 0; c < body.mesh.num_cells(); ++c) {
        const Matrix3<double> F = body.nodes(u, c) * E::gradient_operator(body.mesh.rest_nodes(c)).transpose();
        CHECK((elastic.deformation_gradient(body.d, c) - F).norm() < 1e-12);
    }
}

TEST_CASE_TEMPLATE("world: F is the gradient of x on the rest shape", Body, EVERY_BODY) {
    const Body body;
    using E = typename decltype(body.mesh)::CellElement;
    Elastic<E> elastic(body.mesh, UniformField{Arap<double>()});
    Placement<double> placement;
    WorldFrame::apply(body.mesh, body.skinned, elastic, placement);
    Matrix3X<double> x;
    placement.positions_into(body.d, x);
    CHECK((x - body.posed.positions - body.d).cwiseAbs().maxCoeff() < 1e-15);
    for (Index c = 0; c < body.mesh.num_cells(); ++c) {
        const Matrix3<double> F = body.nodes(x, c) * E::gradient_operator(body.mesh.rest_nodes(c)).transpose();
        CHECK((elastic.deformation_gradient(body.d, c) - F).norm() < 1e-12);
    }
}

TEST_CASE_TEMPLATE("retargeted: F is the gradient of x on the posed shape times the cell's rotation", Body, EVERY_BODY) {
    const Body body;
    using E = typename decltype(body.mesh)::CellElement;
    Elastic<E> elastic(body.mesh, UniformField{Arap<double>()});
    Placement<double> placement;
    RestRetargetedFrame::apply(body.mesh, body.skinned, elastic, placement);
    Matrix3X<double> x;
    placement.positions_into(body.d, x);
    CHECK((x - body.posed.positions - body.d).cwiseAbs().maxCoeff() < 1e-15);
    double farthest_rotation = 0;
    for (Index c = 0; c < body.mesh.num_cells(); ++c) {
        const NodePositions<E, double> p = body.nodes(body.posed.positions, c);
        const Matrix3<double> on_posed = body.nodes(x, c) * E::gradient_operator(p).transpose();
        const Matrix3<double> R =
            polar_rotation(Matrix3<double>(p * E::gradient_operator(body.mesh.rest_nodes(c)).transpose()));
        CHECK((elastic.deformation_gradient(body.d, c) - on_posed * R).norm() < 1e-12);
        CHECK(elastic.rest().volume(c) == doctest::Approx(std::abs(E::rest_volume(p))).epsilon(1e-12));
        farthest_rotation = std::max(farthest_rotation, (R - Matrix3<double>::Identity()).norm());
    }
    CHECK(farthest_rotation > 0.3);
}

TEST_CASE_TEMPLATE("the skinned shape is free of strain in the unposed and the retargeted frame only", Body, EVERY_BODY) {
    const Body body;
    using E = typename decltype(body.mesh)::CellElement;
    const Matrix3X<double> zero = Matrix3X<double>::Zero(3, body.mesh.num_vertices());
    const auto energy_in = [&](auto frame) {
        Elastic<E> elastic(body.mesh, UniformField{Arap<double>()});
        Placement<double> placement;
        decltype(frame)::apply(body.mesh, body.skinned, elastic, placement);
        return elastic.energy(zero, SequentialExecutor{});
    };
    CHECK(energy_in(UnposedFrame{}) == 0.0);
    CHECK(energy_in(RestRetargetedFrame{}) < 1e-28);
    CHECK(energy_in(WorldFrame{}) > 1e-3);
}

TEST_CASE("a frame applied again forgets the pose before") {
    const SkinnedBlock<Tet4, LinearBlend<double>> body;
    Placement<double> at_rest{body.mesh.rest_positions, Matrix3X<double>(3, 3 * body.mesh.num_vertices())};
    for (Index v = 0; v < body.mesh.num_vertices(); ++v) {
        at_rest.maps.middleCols<3>(3 * v).setIdentity();
    }
    const auto energy_after = [&](auto frame, bool posed_first) {
        Elastic<Tet4> elastic(body.mesh, UniformField{Arap<double>()});
        Placement<double> placement;
        if (posed_first) {
            decltype(frame)::apply(body.mesh, body.skinned, elastic, placement);
        }
        decltype(frame)::apply(body.mesh, at_rest, elastic, placement);
        return elastic.energy(body.d, SequentialExecutor{});
    };
    CHECK(energy_after(WorldFrame{}, true) == energy_after(WorldFrame{}, false));
    CHECK(energy_after(RestRetargetedFrame{}, true) == energy_after(RestRetargetedFrame{}, false));
    // at rest all frames agree
    CHECK(energy_after(WorldFrame{}, false) == doctest::Approx(energy_after(UnposedFrame{}, false)).epsilon(1e-11));
    CHECK(energy_after(RestRetargetedFrame{}, false) == doctest::Approx(energy_after(UnposedFrame{}, false)).epsilon(1e-11));
}
