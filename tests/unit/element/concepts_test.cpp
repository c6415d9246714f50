// SPDX-License-Identifier: MIT
#include <softtissue/element/concepts.hpp>

#include <softtissue/core/dual.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

struct WithState : Tet4 {
    double state;
};

struct WithoutInverseMap : Tet4 {
    template <class Scalar>
    static NaturalCoordinates<Scalar> natural_coordinates(const Nodes<Scalar>&, const Vector3<Scalar>&) = delete;
};

struct ReturnsAnExpression : Tet4 {
    template <class Scalar>
    static auto position(const Nodes<Scalar>& X, const Vector3<Scalar>& xi) {
        return X * Tet4::shape_values(xi);
    }
};

static_assert(Element<Tet4, double> && Element<Tet4, float>);
static_assert(Element<Prism6, double> && Element<Prism6, float>);
static_assert(Element<Tet4, Dual<double, 3>> && Element<Prism6, Dual<double, 3>>);
static_assert(!Element<WithState>);
static_assert(!Element<WithoutInverseMap>);
static_assert(!Element<ReturnsAnExpression>);
static_assert(!Element<int>);

}  // namespace

TEST_CASE("node arrays have one column or entry per node") {
    CHECK(NodePositions<Tet4, double>::ColsAtCompileTime == 4);
    CHECK(NodePositions<Prism6, float>::ColsAtCompileTime == 6);
    CHECK(NodeValues<Prism6, double>::RowsAtCompileTime == 6);
}
