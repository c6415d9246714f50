// SPDX-License-Identifier: MIT
/// @file
/// Reproducible random rotations and deformation gradients: the same bits on every platform.
///
/// What        random_normal, random_rotation, random_unit, StateClass, random_state
/// Equation    F = U diag(s) V^T with U, V uniform rotations and singular values s drawn per class
/// Valid       every state keeps s2 + s3 >= 0.1 (s3 signed like det F), so that its rotation is well defined
/// Tests       tests/unit/testing/random_states_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <array>
#include <cstdint>
#include <string_view>

namespace softtissue {

/// A matrix or vector of independent normal() entries.
template <class Matrix>
Matrix random_normal(RandomGenerator& random) {
    using Scalar = typename Matrix::Scalar;
    return Matrix::NullaryExpr([&random] { return Scalar(random.normal()); });
}

/// A unit vector, or a matrix of unit Frobenius norm, uniform over all directions (near enough for tests).
template <class Matrix>
Matrix random_unit(RandomGenerator& random) {
    return random_normal<Matrix>(random).normalized();
}

/// A rotation, uniform over all rotations.
template <RealScalar Scalar>
Matrix3<Scalar> random_rotation(RandomGenerator& random) {
    Eigen::Vector4d q;
    do {  // a point of the ball, clear of its centre
        q = Eigen::Vector4d::NullaryExpr([&random] { return random.uniform(-1, 1); });
    } while (q.squaredNorm() > 1 || q.squaredNorm() < 0.01);
    q.normalize();
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().cast<Scalar>();
}

/// Kinds of deformation gradients that stress a material in different ways.
enum class StateClass {
    identity,         ///< exactly I
    near_identity,    ///< I + entries of size 0.05
    small_strain,     ///< any rotation times a stretch of 0.99 .. 1.01
    general,          ///< singular values 0.5 .. 1.6
    large_stretch,    ///< one singular value 2 .. 3, two of 0.4 .. 0.9
    near_singular,    ///< |s3| from 1e-8 to 1e-2, either sign
    inverted,         ///< det F < 0: s3 from -0.6 to -0.1
    gaussian,         ///< normal entries
    equal_stretches,  ///< two or three equal singular values 0.6 .. 1.5
};

inline constexpr std::array<StateClass, 9> all_state_classes = {
    StateClass::identity, StateClass::near_identity, StateClass::small_strain,
    StateClass::general,  StateClass::large_stretch, StateClass::near_singular,
    StateClass::inverted, StateClass::gaussian,      StateClass::equal_stretches};

/// The classes with det F > 0, for laws with a barrier against inversion.
inline constexpr std::array<StateClass, 6> orientation_preserving_state_classes = {
    StateClass::identity, StateClass::near_identity, StateClass::small_strain,
    StateClass::general,  StateClass::large_stretch, StateClass::equal_stretches};

constexpr std::string_view name_of(StateClass state_class) {
    constexpr std::array<std::string_view, 9> names = {"identity", "near identity", "small strain",
                                                       "general",  "large stretch", "near singular",
                                                       "inverted", "gaussian",      "equal stretches"};
    return names[std::size_t(state_class)];
}

namespace detail {

/// Singular values of a state that is drawn through them; s3 carries the sign of det F.
inline Eigen::Vector3d random_stretches(StateClass state_class, RandomGenerator& random) {
    const auto between = [&random](double low, double high) { return random.uniform(low, high); };
    switch (state_class) {
        case StateClass::small_strain:
            return {between(0.99, 1.01), between(0.99, 1.01), between(0.99, 1.01)};
        case StateClass::large_stretch:
            return {between(2, 3), between(0.4, 0.9), between(0.4, 0.9)};
        case StateClass::near_singular: {
            constexpr std::array<double, 7> sizes = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
            const double size = sizes[std::size_t(random.index(7))];
            return {between(0.8, 1.5), between(0.4, 0.8), random.uniform() < 0.5 ? size : -size};
        }
        case StateClass::inverted:
            return {between(1, 1.5), between(0.8, 1), between(-0.6, -0.1)};
        case StateClass::equal_stretches: {
            const double s = between(0.6, 1.5);
            return {s, s, random.uniform() < 0.5 ? s : between(0.6, 1.5)};
        }
        default:
            return {between(0.5, 1.6), between(0.5, 1.6), between(0.5, 1.6)};
    }
}

/// s2 + s3 with s3 signed like det F: how far the closest rotation is from being ambiguous.
inline double rotation_margin(const Eigen::Matrix3d& F) {
    const Eigen::Vector3d s = Eigen::JacobiSVD<Eigen::Matrix3d>(F).singularValues();
    return F.determinant() < 0 ? s[1] - s[2] : s[1] + s[2];
}

inline Eigen::Matrix3d random_gaussian_state(RandomGenerator& random) {
    Eigen::Matrix3d F = random_normal<Eigen::Matrix3d>(random);
    while (rotation_margin(F) < 0.1) {
        F = random_normal<Eigen::Matrix3d>(random);
    }
    return F;
}

}  // namespace detail

/// A deformation gradient of the given class.
template <RealScalar Scalar>
Matrix3<Scalar> random_state(StateClass state_class, RandomGenerator& random) {
    switch (state_class) {
        case StateClass::identity:
            return Matrix3<Scalar>::Identity();
        case StateClass::near_identity:
            return Matrix3<Scalar>::Identity() + Scalar(0.05) * random_normal<Matrix3<Scalar>>(random);
        case StateClass::gaussian:
            return detail::random_gaussian_state(random).cast<Scalar>();
        default: {
            const Eigen::Matrix3d U = random_rotation<double>(random);
            const Eigen::Matrix3d V = random_rotation<double>(random);
            const Eigen::Vector3d s = detail::random_stretches(state_class, random);
            return (U * s.asDiagonal() * V.transpose()).eval().cast<Scalar>();
        }
    }
}

}  // namespace softtissue
