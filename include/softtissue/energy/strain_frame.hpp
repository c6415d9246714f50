// SPDX-License-Identifier: MIT
/// @file
/// Where strain is measured: in the world, in unposed space, or on a retargeted rest shape.
///
/// What        a StrainFrame policy turns a posed body (skinned positions p, blended skinning maps A) into the two things that
///             energy terms need: the placement x = p + A d of the solver's displacement, and how F follows from d. In every
///             frame d = 0 is the skinned shape, so prescribed vertices keep d = 0 whatever the pose.
/// Equation    unposed     x = p + A d,  F = I + sum d_i g_i^T            (= gradient of u = P^-1 x on the rest shape)
///             world       x = p + d,    F = sum (p_i + d_i) g_i^T        (= gradient of x on the rest shape)
///             retargeted  x = p + d,    F = R + sum d_i (R^T g^p_i)^T    (= gradient of x on the posed shape p, times R)
///             R, the rotation of the cell from rest to p, carries an anisotropic law's axes along; |V_p| weights the cell.
/// Why         d in unposed space: nothing of the pose enters the elastic energy, and a near-singular A is never inverted
/// Source      Romero et al. 2020, sec. 4.2 and fig. 4 (unposed; world as Kim et al. 2017; retargeted as Kautzman et al. 2019)
/// Tests       tests/unit/energy/strain_frame_test.cpp, tests/scenario/static_pose_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/placement.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <cmath>
#include <concepts>

namespace softtissue {

/// Strain of the deformation that inverse skinning leaves: static poses cost nothing.
struct UnposedFrame {
    /// Whether d lives in unposed space (else in the world).
    static constexpr bool is_unposed = true;

    /// `skinned` has the posed shape p and its blended maps A; they are taken over.
    template <class Elastic, class Scalar>
    static void apply(const typename Elastic::Mesh&, const Placement<Scalar>& skinned, Elastic&,
                      Placement<Scalar>& placement) {
        placement = skinned;
    }
};

/// Strain of the world positions against the rest shape.
struct WorldFrame {
    static constexpr bool is_unposed = false;

    template <class Elastic, class Scalar>
    static void apply(const typename Elastic::Mesh&, const Placement<Scalar>& skinned, Elastic& elastic,
                      Placement<Scalar>& placement) {
        placement.origins = skinned.origins;
        placement.maps.resize(3, 0);
        for (Index c = 0; c < elastic.num_cells(); ++c) {
            const auto p = Elastic::Mesh::gather(skinned.origins, elastic.cells().col(c));
            elastic.mutable_rest().set_reference_gradient(c, p * elastic.rest().gradients(c).transpose());
        }
    }
};

/// Strain of the world positions against the skinned shape, which is taken as the rest shape of each pose.
struct RestRetargetedFrame {
    static constexpr bool is_unposed = false;

    template <class Elastic, class Scalar>
    static void apply(const typename Elastic::Mesh& mesh, const Placement<Scalar>& skinned, Elastic& elastic,
                      Placement<Scalar>& placement) {
        placement.origins = skinned.origins;
        placement.maps.resize(3, 0);
        using E = typename Elastic::CellElement;
        for (Index c = 0; c < elastic.num_cells(); ++c) {
            const NodePositions<E, Scalar> p = mesh.gather(skinned.origins, mesh.cells.col(c));
            const Matrix3<Scalar> posing = p * E::gradient_operator(mesh.rest_nodes(c)).transpose();
            const Matrix3<Scalar> R = polar_rotation(posing);
            elastic.mutable_rest().set_cell(c, R.transpose() * E::gradient_operator(p), std::abs(E::rest_volume(p)));
            elastic.mutable_rest().set_reference_gradient(c, R);
        }
    }
};

/// A policy as above, for elastic energies of type `Elastic`.
template <class T, class Elastic>
concept StrainFrame = requires(const typename Elastic::Mesh& mesh, const Placement<typename Elastic::Scalar>& skinned,
                               Elastic& elastic, Placement<typename Elastic::Scalar>& placement) {
    { T::is_unposed } -> std::convertible_to<bool>;
    T::apply(mesh, skinned, elastic, placement);
};

}  // namespace softtissue
