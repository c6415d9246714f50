// SPDX-License-Identifier: MIT
/// @file
/// The laws every element must obey, checked on seeded random cells.
///
///     NodePositions<MyElement, double> reference;   // one well-shaped cell, nodes in the documented order
///     const LawReport report = check_element_laws<MyElement, double>(reference);
///     if (!report.all_passed()) { std::cerr << report.summary(); }
///
/// Cells       the reference cell with noise on its nodes, stretched, rotated, moved; thin ones included
/// Laws        "positive cell"        the Jacobian bound of the reference cell is positive, the volumes are
///             "mirrored cell"        a mirrored cell has the opposite volume
///             "mirrored bound"       and no positive bound
///             "partition of unity"   the gradients of a cell, and of N at a point, sum to 0; the N_i to 1
///             "affine maps"          the deformation gradient of x = A X + t is A
///             "shape integrals"      sum to the volume
///             "node values"          N_i at node j is delta_ij
///             "inverse map"          natural_coordinates(position(xi)) = xi
///             "shape gradient rate"  shape_gradients are the derivatives of N by position: Taylor order 2
///             "similarity"           turned, moved and scaled cells have turned and scaled results
///             "symmetries"           E::symmetries leave volume, bound, integrals and gradients as they are
///             "faces closed"         the area vectors of E::faces sum to 0
///             "faces volume"         the flux through E::faces is the volume
///             "faces outward"        every face looks away from the middle of the reference cell
/// Measures    relative to the terms that are summed; the tolerance is round_off times epsilon of the scalar
/// Tests       tests/laws/element_laws_{tet4,prism6}_test.cpp, tests/unit/testing/element_laws_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/testing/law_report.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace softtissue {

struct ElementLawOptions {
    int samples = 50;
    std::uint64_t seed = 1;
    double noise =
        0.1;  ///< of the nodes, relative to the extent of the reference cell; halved until a cell is positive
    double thinnest = 0.1;  ///< smallest stretch of the reference cell
    /// Allowed round-off, in epsilon of the scalar: chains of some ten operations, amplified by the shape of the cells.
    double round_off = 100;
};

namespace detail {

template <class E, RealScalar Scalar>
class ElementLawSuite {
public:
    using Nodes = NodePositions<E, Scalar>;
    using Values = NodeValues<E, Scalar>;

    ElementLawSuite(const Nodes& reference, const ElementLawOptions& options)
        : reference_(reference),
          options_(options),
          random_(options.seed),
          tolerance_(options.round_off * double(std::numeric_limits<Scalar>::epsilon())) {}

    LawReport report() {
        const Scalar bound = E::smallest_jacobian_bound(reference_);
        positive("positive cell", bound, "reference cell");
        if (!(bound > Scalar(0))) {
            return std::move(report_);
        }
        check_faces_outward();
        for (int sample = 0; sample < options_.samples; ++sample) {
            where_ = "sample " + std::to_string(sample);
            X_ = random_cell();
            check_cell();
            check_shape_functions();
            check_similarity();
            check_symmetries();
            check_faces();
        }
        return std::move(report_);
    }

private:
    Nodes reference_;
    ElementLawOptions options_;
    RandomGenerator random_;
    double tolerance_;
    LawReport report_;
    std::string where_;
    Nodes X_;

    void positive(const char* law, Scalar value, const std::string& where) {
        report_.at_least(law, double(value), std::numeric_limits<double>::min(), where);
    }

    /// `error` relative to `size`, both norms.
    void small(const char* law, Scalar error, Scalar size) {
        report_.at_most(law, double(error / size), tolerance_, where_);
    }

    static Nodes centred(const Nodes& X) {
        const Vector3<Scalar> middle = X.rowwise().mean();
        return X.colwise() - middle;
    }

    Nodes random_cell() {
        const Nodes local = centred(reference_);
        const Scalar extent = local.colwise().norm().maxCoeff();
        Scalar noise = extent * Scalar(options_.noise);
        Nodes shape;
        do {
            shape = local + noise / std::sqrt(Scalar(3)) * random_normal<Nodes>(random_);
            noise /= Scalar(2);
        } while (!(E::smallest_jacobian_bound(shape) > Scalar(0)));
        const Vector3<Scalar> stretch = Vector3<Scalar>::NullaryExpr(
            [this] { return Scalar(std::exp(random_.uniform(std::log(options_.thinnest), 0))); });
        const Matrix3<Scalar> A =
            random_rotation<Scalar>(random_) * stretch.asDiagonal() * random_rotation<Scalar>(random_);
        const Vector3<Scalar> away = extent * random_unit<Vector3<Scalar>>(random_);
        return (A * shape).colwise() + away;
    }

    /// A point between the natural coordinates of the nodes.
    Vector3<Scalar> random_point() {
        Values weights = Values::NullaryExpr([this] { return Scalar(random_.uniform(0.05, 1)); });
        weights /= weights.sum();
        Vector3<Scalar> xi = Vector3<Scalar>::Zero();
        for (int i = 0; i < E::num_nodes; ++i) {
            const Vector3<Scalar> node = X_.col(i);
            xi += weights(i) * E::natural_coordinates(X_, node).coordinates;
        }
        return xi;
    }

    void check_cell() {
        const Scalar volume = E::rest_volume(X_);
        positive("positive cell", volume, where_);
        Nodes mirrored = X_;
        mirrored.row(0) *= Scalar(-1);
        small("mirrored cell", std::abs(E::rest_volume(mirrored) + volume), volume);
        positive("mirrored bound", -E::smallest_jacobian_bound(mirrored), where_);

        const Values integrals = E::shape_integrals(X_);
        small("shape integrals", std::abs(integrals.sum() - volume), integrals.cwiseAbs().sum());

        const Nodes g = E::gradient_operator(X_);
        small("partition of unity", g.rowwise().sum().norm(), g.norm());
        const Matrix3<Scalar> A = random_normal<Matrix3<Scalar>>(random_);
        const Nodes x = A * centred(X_);
        small("affine maps", (x * g.transpose() - A).norm(), x.norm() * g.norm());
    }

    void check_shape_functions() {
        for (int j = 0; j < E::num_nodes; ++j) {
            const Vector3<Scalar> node = X_.col(j);
            const NaturalCoordinates<Scalar> found = E::natural_coordinates(X_, node);
            const Values unit = Values::Unit(j);
            small("node values", found.converged ? (E::shape_values(found.coordinates) - unit).norm() : Scalar(1),
                  condition());
        }
        const Vector3<Scalar> xi = random_point();
        const Vector3<Scalar> other = random_point();
        const Vector3<Scalar> p = E::position(X_, xi);
        const NaturalCoordinates<Scalar> found = E::natural_coordinates(X_, p);
        small("inverse map", found.converged ? (found.coordinates - xi).norm() : Scalar(1), condition());

        const Values N = E::shape_values(xi);
        small("partition of unity", std::abs(N.sum() - Scalar(1)), N.cwiseAbs().sum());
        const Nodes gradients = E::shape_gradients(X_, xi);
        small("partition of unity", gradients.rowwise().sum().norm(), gradients.norm());

        const Vector3<Scalar> direction = E::position(X_, other) - p;
        const auto along = [&](Scalar h) -> Values {
            const Vector3<Scalar> moved = p + h * direction;
            return E::shape_values(E::natural_coordinates(X_, moved).coordinates);
        };
        const Values slope = gradients.transpose() * direction;
        const TaylorRate rate = taylor_rate(along, slope);
        report_.at_least("shape gradient rate", rate.is_exact ? 2.0 : rate.order, 1.9, where_);
    }

    /// How much natural coordinates magnify round-off in positions.
    Scalar condition() const { return X_.norm() * E::gradient_operator(X_).norm(); }

    void check_similarity() {
        const Matrix3<Scalar> R = random_rotation<Scalar>(random_);
        const Scalar scale = Scalar(random_.uniform(0.5, 2));
        const Vector3<Scalar> shift = X_.norm() * random_unit<Vector3<Scalar>>(random_);
        const Nodes Y = (scale * R * X_).colwise() + shift;
        compare("similarity", Y, E::gradient_operator(X_), E::shape_integrals(X_), scale, R);
    }

    void check_symmetries() {
        if constexpr (requires { E::symmetries; }) {
            const Nodes g = E::gradient_operator(X_);
            const Values integrals = E::shape_integrals(X_);
            for (const auto& order : E::symmetries) {
                Nodes Y;
                Nodes permuted_g;
                Values permuted_integrals;
                for (int k = 0; k < E::num_nodes; ++k) {
                    const int node = order[std::size_t(k)];
                    Y.col(k) = X_.col(node);
                    permuted_g.col(k) = g.col(node);
                    permuted_integrals(k) = integrals(node);
                }
                compare("symmetries", Y, permuted_g, permuted_integrals, Scalar(1), Matrix3<Scalar>::Identity());
            }
        }
    }

    /// The results for Y, a copy of X_ scaled and turned, against those expected.
    void compare(const char* law, const Nodes& Y, const Nodes& g, const Values& integrals, Scalar scale,
                 const Matrix3<Scalar>& R) {
        const Scalar cube = scale * scale * scale;
        const Scalar volume = cube * E::rest_volume(X_);
        small(law, std::abs(E::rest_volume(Y) - volume), volume * condition());
        small(law, std::abs(E::smallest_jacobian_bound(Y) - cube * E::smallest_jacobian_bound(X_)),
              volume * condition());
        small(law, (E::shape_integrals(Y) - cube * integrals).norm(), volume * condition());
        small(law, (scale * E::gradient_operator(Y) - R * g).norm(), g.norm() * condition());
    }

    Vector3<Scalar> node(const Nodes& X, const ElementFace& face, int k) const {
        return X.col(face.nodes[std::size_t(k % face.num_nodes)]);
    }

    /// Exact for a bilinear quadrilateral too.
    Vector3<Scalar> area_vector(const Nodes& X, const ElementFace& face) const {
        const int last = face.num_nodes - 1;
        const Vector3<Scalar> diagonal = node(X, face, 2) - node(X, face, 0);
        return (node(X, face, 1) - node(X, face, last)).cross(diagonal) / Scalar(2);
    }

    /// A third of the flux of x: exact for a bilinear quadrilateral, the mean of its two cuts into triangles.
    Scalar volume_under(const Nodes& X, const ElementFace& face) const {
        Scalar sum(0);
        for (int first = 0; first < face.num_nodes; ++first) {
            sum += node(X, face, first).cross(node(X, face, first + 1)).dot(node(X, face, first + 2)) / Scalar(6);
        }
        return sum / Scalar(face.num_nodes == 3 ? 3 : 2);
    }

    void check_faces() {
        if constexpr (requires { E::faces; }) {
            const Nodes X = centred(X_);
            Vector3<Scalar> area = Vector3<Scalar>::Zero();
            Scalar volume(0);
            Scalar size(0);
            for (const ElementFace& face : E::faces) {
                area += area_vector(X, face);
                size += area_vector(X, face).norm();
                volume += volume_under(X, face);
            }
            small("faces closed", area.norm(), size);
            small("faces volume", std::abs(volume - E::rest_volume(X_)), size * X.norm());
        }
    }

    void check_faces_outward() {
        if constexpr (requires { E::faces; }) {
            const Nodes X = centred(reference_);
            for (const ElementFace& face : E::faces) {
                positive("faces outward", node(X, face, 0).dot(area_vector(X, face)), "reference cell");
            }
        }
    }
};

}  // namespace detail

/// The laws of element E, on cells like `reference`.
template <class E, RealScalar Scalar>
    requires Element<E, Scalar> LawReport check_element_laws(const NodePositions<E, Scalar>& reference,
                                                             const ElementLawOptions& options = {}) {
        return detail::ElementLawSuite<E, Scalar>(reference, options).report();
    }

}  // namespace softtissue
