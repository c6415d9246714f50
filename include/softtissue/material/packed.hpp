// SPDX-License-Identifier: MIT
/// @file
/// The laws of several cells as one law over a pack: a lane per cell.
///
/// What        packed_law<N>(law): law(i), a material over float or double, in lane i
/// Packable    a material that has `template <int N, class Law> static auto packed(const Law& law)` is evaluated with all lanes
///             at once: it gathers its coefficients into packs and returns itself over Pack<Scalar, N>
/// Others      any HyperelasticMaterial is evaluated lane by lane: right, as fast as it is by itself
/// Tests       tests/unit/material/packed_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/psd_filter.hpp>

#include <type_traits>
#include <utility>

namespace softtissue {

/// N materials that know nothing of packs; `law(i)` must stay valid.
template <int N, class Law>
class LaneByLane {
public:
    using Material = std::remove_cvref_t<decltype(std::declval<const Law&>()(0))>;
    using Scalar = Pack<typename Material::Scalar, N>;

    explicit LaneByLane(const Law& law) : law_(law) {}

    Scalar energy_density(const Matrix3<Scalar>& F) const {
        return Scalar::from_lanes([&](int i) { return law_(i).energy_density(lane(F, i)); });
    }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const {
        return packed_matrix<N>([&](int i) { return law_(i).first_piola(lane(F, i)); });
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const { return projected_hessian(F, PsdFilter::none); }

    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter filter) const {
        return packed_matrix<N>([&](int i) { return softtissue::projected_hessian(law_(i), lane(F, i), filter); });
    }

private:
    Law law_;
};

/// Gathers the coefficients of N laws into one law over packs.
template <class M, int N>
concept PackableMaterial = HyperelasticMaterial<M> && RealScalar<typename M::Scalar> && requires(const M& (*law)(int)) {
    {
        M::template packed<N>(law).energy_density(Matrix3<Pack<typename M::Scalar, N>>())
        } -> std::same_as<Pack<typename M::Scalar, N>>;
};

/// N laws as one; see the file comment.
template <int N, class Law>
auto packed_law(const Law& law) {
    using Material = std::remove_cvref_t<decltype(law(0))>;
    if constexpr (PackableMaterial<Material, N>) {
        return Material::template packed<N>(law);
    } else {
        return LaneByLane<N, Law>(law);
    }
}

/// The laws of a pack of `field`'s cells, cell(i) in lane i; a field may offer them itself as packed_at(pack).
template <int N, class Field, class CellOf>
auto packed_law_at(const Field& field, Index pack, const CellOf& cell) {
    if constexpr (requires { field.packed_at(pack); }) {
        static_assert(num_lanes<typename decltype(field.packed_at(pack))::Scalar> == N);
        return field.packed_at(pack);
    } else {
        return packed_law<N>([&field, cell](int i) -> decltype(auto) { return field.at(cell(i)); });
    }
}

}  // namespace softtissue
