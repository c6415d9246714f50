// SPDX-License-Identifier: MIT
// Winding numbers of a closed and an open surface.
#include "reference_case.hpp"

#include <softtissue/mesh/winding_number.hpp>

#include <cstdint>

namespace reference_check {
namespace {

using namespace softtissue;

void check_surface(const ReferenceCase& reference, const char* triangles, const char* expected, const char* quantity,
                   const char* far_quantity, Checklist& checks) {
    const Matrix3X<double> queries = reference.points("Q");
    const WindingNumber<double> winding(reference.points("V"), reference.file.at(triangles).columns<std::int32_t, 3>());
    VectorX<double> exact(queries.cols());
    VectorX<double> hierarchical(queries.cols());
    for (Index i = 0; i < queries.cols(); ++i) {
        exact(i) = winding.exact(queries.col(i));
    }
    winding.evaluate_into(queries, hierarchical);
    const VectorX<double> truth = reference.flat(expected);
    checks.add(reference.name, quantity, relative_difference(exact, truth, 1.0), 1e-10);
    checks.add(reference.name, far_quantity, relative_difference(hierarchical, truth, 1.0), 1.5e-2);
}

}  // namespace

void check_winding_number(const ReferenceCase& reference, Checklist& checks) {
    check_surface(reference, "F", "wn_closed", "closed surface, exact", "closed surface, hierarchical", checks);
    check_surface(reference, "F_open", "wn_open", "open surface, exact", "open surface, hierarchical", checks);
}

}  // namespace reference_check
