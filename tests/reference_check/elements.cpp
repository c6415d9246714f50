// SPDX-License-Identifier: MIT
// Geometry of single cells: volume, gradient operator, shape functions, inverse map.
#include "reference_case.hpp"

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>

#include <algorithm>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double element_tolerance = 1e-12;

/// Rows r .. r + n - 1 of an array read as rows of `width` numbers, as columns.
template <int n>
Eigen::Matrix<double, 3, n> rows3(const VectorX<double>& values, Index first) {
    return Eigen::Map<const Eigen::Matrix<double, 3, n>>(values.data() + 3 * first);
}

template <class ElementType>
struct CellErrors {
    double volume = 0.0;
    double operator_error = 0.0;
    double deformation_gradient = 0.0;

    void add(const NodePositions<ElementType, double>& X, double reference_volume,
             const NodePositions<ElementType, double>& reference_gradients, const NodePositions<ElementType, double>& phi,
             const Matrix3<double>& reference_F) {
        volume = std::max(volume, std::abs(ElementType::rest_volume(X) - reference_volume) / reference_volume);
        const NodePositions<ElementType, double> g = ElementType::gradient_operator(X);
        operator_error = std::max(operator_error, relative_difference(g, reference_gradients));
        // F sums products of positions and gradients; its natural unit is the largest of them
        const double scale = phi.cwiseAbs().maxCoeff() * reference_gradients.cwiseAbs().maxCoeff();
        deformation_gradient =
            std::max(deformation_gradient, relative_difference(Matrix3<double>(phi * g.transpose()), reference_F, scale));
    }

    void report(const ReferenceCase& reference, Checklist& checks) const {
        checks.add(reference.name, "volume", volume, element_tolerance);
        checks.add(reference.name, "gradient operator", operator_error, element_tolerance);
        checks.add(reference.name, "deformation gradient", deformation_gradient, element_tolerance);
    }
};

}  // namespace

void check_tet(const ReferenceCase& reference, Checklist& checks) {
    const VectorX<double> X = reference.flat("X");
    const VectorX<double> g = reference.flat("g");
    const VectorX<double> phi = reference.flat("phi");
    const VectorX<double> volume = reference.file.at("volume").vector<double>();
    const auto F = reference.file.at("F").matrices<double, 3, 3>();
    CellErrors<Tet4> errors;
    for (Index c = 0; c < volume.size(); ++c) {
        errors.add(rows3<4>(X, 4 * c), volume(c), rows3<4>(g, 4 * c), rows3<4>(phi, 4 * c), F[size_t(c)]);
    }
    errors.report(reference, checks);
}

void check_prism(const ReferenceCase& reference, Checklist& checks) {
    const VectorX<double> X = reference.flat("X");
    const VectorX<double> g = reference.flat("g");
    const VectorX<double> phi = reference.flat("phi");
    const VectorX<double> volume = reference.file.at("volume").vector<double>();
    const VectorX<double> integrals = reference.flat("int_N");
    const VectorX<double> xi = reference.flat("xi");
    const VectorX<double> points = reference.flat("x");
    const VectorX<double> values = reference.flat("N");
    const VectorX<double> gradients = reference.flat("dNdx");
    const auto A = reference.file.at("A").matrices<double, 3, 3>();
    const Index points_per_cell = reference.file.at("xi").shape()[1];
    CellErrors<Prism6> errors;
    double integral = 0.0, position = 0.0, value = 0.0, gradient = 0.0, inverse = 0.0;
    for (Index c = 0; c < volume.size(); ++c) {
        const NodePositions<Prism6, double> nodes = rows3<6>(X, 6 * c);
        errors.add(nodes, volume(c), rows3<6>(g, 6 * c), rows3<6>(phi, 6 * c), A[size_t(c)]);
        integral = std::max(integral,
                            relative_difference(Prism6::shape_integrals(nodes), integrals.segment<6>(6 * c), volume(c)));
        for (Index k = points_per_cell * c; k < points_per_cell * (c + 1); ++k) {
            const Vector3<double> natural = xi.segment<3>(4 * k + 1);
            const Vector3<double> point = points.segment<3>(3 * k);
            position = std::max(position, relative_difference(Prism6::position(nodes, natural), point,
                                                              nodes.cwiseAbs().maxCoeff()));
            value = std::max(value, relative_difference(Prism6::shape_values(natural), values.segment<6>(6 * k), 1.0));
            gradient = std::max(gradient,
                                relative_difference(Prism6::shape_gradients(nodes, natural), rows3<6>(gradients, 6 * k)));
            const auto found = Prism6::natural_coordinates(nodes, point);
            inverse = std::max(inverse, found.converged ? relative_difference(found.coordinates, natural, 1.0) : 1.0);
        }
    }
    errors.report(reference, checks);
    checks.add(reference.name, "shape integrals / volume", integral, element_tolerance);
    checks.add(reference.name, "position", position, element_tolerance);
    checks.add(reference.name, "shape values", value, element_tolerance);
    checks.add(reference.name, "shape gradients", gradient, element_tolerance);
    // stored coordinates are the constructing ones: up to 1e-12 from the inverse of the rounded point
    checks.add(reference.name, "inverse map", inverse, 2.0 * element_tolerance);
}

}  // namespace reference_check
