// SPDX-License-Identifier: MIT
#include <softtissue/material/field.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/material/concepts.hpp>

#include <concepts>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
struct Spring {
    using Scalar = S;
    S stiffness;
    S energy_density(const Matrix3<S>& F) const { return stiffness / 2 * F.squaredNorm(); }
    Matrix3<S> first_piola(const Matrix3<S>& F) const { return stiffness * F; }
    Matrix9<S> hessian(const Matrix3<S>&) const { return stiffness * Matrix9<S>::Identity(); }
};

/// A field that makes its materials on the fly and returns them by value.
struct GradedField {
    Spring<double> at(Index cell) const { return {double(cell)}; }
    Index num_cells() const { return 3; }
};

}  // namespace

static_assert(MaterialField<UniformField<Spring<double>>> && MaterialField<UniformField<Spring<float>>>);
static_assert(MaterialField<CellField<Spring<double>>> && MaterialField<CellField<Spring<float>>>);
static_assert(MaterialField<GradedField>);
static_assert(!MaterialField<Spring<double>>, "a material is not a field");
static_assert(std::same_as<MaterialOf<CellField<Spring<float>>>, Spring<float>>);
static_assert(std::same_as<decltype(UniformField{Spring<float>{}}), UniformField<Spring<float>>>);

TEST_CASE_TEMPLATE("a uniform field is the same material everywhere, without a copy", S, float, double) {
    const UniformField field{Spring<S>{S(3)}};
    CHECK(field.at(0).stiffness == S(3));
    CHECK(&field.at(0) == &field.at(1000000));
}

TEST_CASE_TEMPLATE("a cell field has one material per cell", S, float, double) {
    const CellField field(std::vector<Spring<S>>{{S(1)}, {S(2)}, {S(5)}});
    CHECK(field.num_cells() == 3);
    CHECK(field.at(0).stiffness == S(1));
    CHECK(field.at(2).stiffness == S(5));
    CHECK(&field.at(2) == &field.at(2));
}

TEST_CASE("a field of the wrong size is refused in words") {
    CHECK_THROWS_WITH_AS(CellField<Spring<double>>({}), "CellField: number of materials = 0, expected one per cell",
                         InvalidInput);
    const CellField field(std::vector<Spring<double>>{{1}, {2}});
    CHECK_NOTHROW(require_covers(field, 2));
    CHECK_THROWS_WITH_AS(require_covers(field, 3),
                         "material field: number of materials = 2, expected one for each of 3 cells", InvalidInput);
    CHECK_NOTHROW(require_covers(UniformField{Spring<double>{1}}, 3));
    CHECK_THROWS_AS(require_covers(GradedField{}, 4), InvalidInput);
}
