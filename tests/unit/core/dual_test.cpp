// SPDX-License-Identifier: MIT
#include <softtissue/core/dual.hpp>

#include <doctest/doctest.h>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>
#include <type_traits>

using namespace softtissue;

static_assert(FieldScalar<Dual<double, 9>> && FieldScalar<Dual<float, 1>> && FieldScalar<Dual<Dual<double, 9>, 9>>);
static_assert(!RealScalar<Dual<double, 9>>);
static_assert(std::same_as<RealOf<Dual<Dual<float, 2>, 3>>, float>);
static_assert(std::is_trivially_copyable_v<Dual<double, 9>> && std::is_trivial_v<Dual<Dual<double, 9>, 9>>);
static_assert(Dual<double, 2>{} == 0 && Dual<double, 2>{}.derivative[1] == 0, "braces give zero");
static_assert((Dual<double, 1>::variable(3, 0) * Dual<double, 1>::variable(3, 0)).derivative[0] == 6);
static_assert(std::convertible_to<int, Dual<float, 2>> && std::convertible_to<double, Dual<Dual<double, 2>, 2>>);
static_assert(!std::convertible_to<Dual<double, 2>, double>, "derivatives must not get lost silently");

namespace {

/// Round-off of a handful of operations, relative to the size of the result.
template <class S>
doctest::Approx near(S expected) {
    return doctest::Approx(double(expected)).epsilon(64 * double(std::numeric_limits<S>::epsilon()));
}

/// A function of one variable: value, first and second derivative by nested duals against closed forms.
template <class S, class F>
void check_derivatives(const char* name, const F& f, S x, S first, S second) {
    CAPTURE(name);
    CAPTURE(x);
    using Once = Dual<S, 1>;
    using Twice = Dual<Once, 1>;
    const Twice y = f(Twice::variable(Once::variable(x, 0), 0));
    CHECK(double(y.value.value) == near<S>(f(x)));
    CHECK(double(y.value.derivative[0]) == near<S>(first));
    CHECK(double(y.derivative[0].value) == near<S>(first));
    CHECK(double(y.derivative[0].derivative[0]) == near<S>(second));
}

/// A matrix whose entries are the nine variables of vec(F).
template <class S>
Matrix3<Dual<S, 9>> with_variables(const Matrix3<S>& F) {
    Matrix3<Dual<S, 9>> result;
    for (int k = 0; k < 9; ++k) {
        result.data()[k] = Dual<S, 9>::variable(F.data()[k], k);
    }
    return result;
}

template <class S>
Matrix3<S> gradient(const Dual<S, 9>& y) {
    return Eigen::Map<const Matrix3<S>>(y.derivative.data());
}

template <class S>
Matrix3<S> sample_matrix() {
    Matrix3<S> F;
    F << S(1.1), S(0.2), S(-0.3), S(0.4), S(0.9), S(0.1), S(-0.2), S(0.5), S(1.3);
    return F;
}

template <class S>
void check_equal(const Matrix3<S>& actual, const Matrix3<S>& expected) {
    CHECK(double((actual - expected).norm()) <=
          64 * double(std::numeric_limits<S>::epsilon()) * double(expected.norm()));
}

}  // namespace

TEST_CASE_TEMPLATE("elementary functions have their first and second derivatives", S, float, double) {
    using std::abs, std::acos, std::cos, std::erf, std::exp, std::expm1, std::log, std::log1p, std::pow, std::sin,
        std::sqrt, std::tan, std::tanh;
    for (const S x : {S(0.1), S(0.35), S(0.7), S(0.9)}) {
        check_derivatives<S>(
            "sqrt", [](auto v) { return sqrt(v); }, x, S(0.5) / sqrt(x), S(-0.25) / (x * sqrt(x)));
        check_derivatives<S>(
            "exp", [](auto v) { return exp(v); }, x, exp(x), exp(x));
        check_derivatives<S>(
            "expm1", [](auto v) { return expm1(v); }, x, exp(x), exp(x));
        check_derivatives<S>(
            "log", [](auto v) { return log(v); }, x, 1 / x, -1 / (x * x));
        check_derivatives<S>(
            "log1p", [](auto v) { return log1p(v); }, x, 1 / (1 + x), -1 / ((1 + x) * (1 + x)));
        check_derivatives<S>(
            "x^3", [](auto v) { return pow(v, S(3)); }, x, 3 * x * x, 6 * x);
        check_derivatives<S>(
            "x^2.5", [](auto v) { return pow(v, S(2.5)); }, x, S(2.5) * pow(x, S(1.5)), S(3.75) * pow(x, S(0.5)));
        check_derivatives<S>(
            "x^x", [](auto v) { return pow(v, v); }, x, pow(x, x) * (log(x) + 1),
            pow(x, x) * ((log(x) + 1) * (log(x) + 1) + 1 / x));
        check_derivatives<S>(
            "sin", [](auto v) { return sin(v); }, x, cos(x), -sin(x));
        check_derivatives<S>(
            "cos", [](auto v) { return cos(v); }, x, -sin(x), -cos(x));
        const S t = tan(x);
        check_derivatives<S>(
            "tan", [](auto v) { return tan(v); }, x, 1 + t * t, 2 * t * (1 + t * t));
        const S c = sqrt(1 - x * x);
        check_derivatives<S>(
            "acos", [](auto v) { return acos(v); }, x, -1 / c, -x / (c * c * c));
        const S th = tanh(x);
        check_derivatives<S>(
            "tanh", [](auto v) { return tanh(v); }, x, 1 - th * th, -2 * th * (1 - th * th));
        const S g = 2 * std::numbers::inv_sqrtpi_v<S> * exp(-x * x);
        check_derivatives<S>(
            "erf", [](auto v) { return erf(v); }, x, g, -2 * x * g);
        check_derivatives<S>(
            "abs", [](auto v) { return abs(v); }, -x, S(-1), S(0));
        check_derivatives<S>(
            "abs", [](auto v) { return abs(v); }, x, S(1), S(0));
        check_derivatives<S>(
            "1/x", [](auto v) { return 1 / v; }, x, -1 / (x * x), 2 / (x * x * x));
        check_derivatives<S>(
            "arithmetic with plain numbers", [](auto v) { return (3 - v) * S(2) + v / 4 - (v - 1) * v + (2 + v); }, x,
            S(-2) + S(0.25) - (2 * x - 1) + 1, S(-2));
    }
}

TEST_CASE_TEMPLATE("integer powers take zero and negative values", S, float, double) {
    using D = Dual<S, 1>;
    const D zero = D::variable(S(0), 0);
    CHECK(pow(zero, 0).derivative[0] == S(0));
    CHECK(pow(zero, 1).derivative[0] == S(1));
    CHECK(pow(zero, 2).derivative[0] == S(0));
    const D negative = D::variable(S(-2), 0);
    CHECK(pow(negative, 3).value == S(-8));
    CHECK(pow(negative, 3).derivative[0] == S(12));
}

TEST_CASE_TEMPLATE("functions of two variables have both partial derivatives", S, float, double) {
    using D = Dual<S, 2>;
    const S x = S(0.7);
    const S y = S(-1.3);
    const D X = D::variable(x, 0);
    const D Y = D::variable(y, 1);
    const auto check = [](const D& f, S along_x, S along_y) {
        CHECK(double(f.derivative[0]) == near<S>(along_x));
        CHECK(double(f.derivative[1]) == near<S>(along_y));
    };
    check(X + Y, S(1), S(1));
    check(X - Y, S(1), S(-1));
    check(-X, S(-1), S(0));
    check(X * Y, y, x);
    check(X / Y, 1 / y, -x / (y * y));
    const S r2 = x * x + y * y;
    check(atan2(Y, X), -y / r2, x / r2);
    D sum = X;
    sum += Y;
    sum *= X;
    sum -= Y;
    sum /= X;  // ((x + y) x - y) / x = x + y - y / x
    check(sum, 1 + y / (x * x), 1 - 1 / x);
}

TEST_CASE("comparisons look at the values alone") {
    using D = Dual<double, 1>;
    const D one = D::variable(1, 0);
    CHECK(one == 1);
    CHECK(one == D(1));
    CHECK(one < 2.0);
    CHECK(0 < one);
    CHECK(one >= D(1));
    const D nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(nan < one);
    CHECK_FALSE(nan >= one);
    CHECK_FALSE(nan == nan);
    CHECK(value_of(Dual<D, 1>(one)) == 1.0);
}

TEST_CASE_TEMPLATE("fixed-size Eigen matrices of duals differentiate", S, float, double) {
    using D = Dual<S, 9>;
    const Matrix3<S> F = sample_matrix<S>();
    const Matrix3<D> G = with_variables<S>(F);
    const Matrix3<S> inverse = F.inverse();
    const Matrix3<S> cofactor = F.determinant() * inverse.transpose();
    const Vector3<S> a(S(0.3), S(-0.8), S(0.5));
    const Vector3<S> b(S(1.2), S(0.1), S(-0.4));

    check_equal<S>(gradient<S>(G.determinant()), cofactor);
    check_equal<S>(gradient<S>(G.squaredNorm()), 2 * F);
    check_equal<S>(gradient<S>(G.norm()), F / F.norm());
    check_equal<S>(gradient<S>(G.trace()), Matrix3<S>::Identity());
    check_equal<S>(gradient<S>((G.transpose() * G).trace()), 2 * F);
    check_equal<S>(gradient<S>((G - Matrix3<D>::Identity()).squaredNorm()), 2 * (F - Matrix3<S>::Identity()));
    check_equal<S>(gradient<S>(G.cwiseProduct(G).sum()), 2 * F);

    SUBCASE("inverse") {
        // d (a . F^-1 b) / dF = -(F^-T a) (F^-1 b)^T
        const Matrix3<D> inverse_dual = G.inverse();
        const D y = a.template cast<D>().dot(inverse_dual * b.template cast<D>());
        check_equal<S>(gradient<S>(y), -(inverse.transpose() * a) * (inverse * b).transpose());
    }
    SUBCASE("cross product") {
        // c . (f0 x f1) = det(c, f0, f1)
        const Vector3<D> normal = G.col(0).cross(G.col(1));
        Matrix3<S> expected = Matrix3<S>::Zero();
        expected.col(0) = F.col(1).cross(a);
        expected.col(1) = a.cross(F.col(0));
        check_equal<S>(gradient<S>(normal.dot(a.template cast<D>())), expected);
    }
    SUBCASE("plain scalars and matrices mix in") {
        check_equal<S>(gradient<S>((S(2) * G).trace() + (G * S(3)).trace() - (G / S(4)).trace()),
                       S(4.75) * Matrix3<S>::Identity());
        check_equal<S>(gradient<S>((2 * G).trace()), S(2) * Matrix3<S>::Identity());
        const Vector3<D> fibre = G * a;  // no cast needed
        check_equal<S>(gradient<S>(fibre.squaredNorm()), 2 * F * a * a.transpose());
    }
    SUBCASE("normalised vector") {
        const Vector3<D> unit = G.col(2).normalized();
        const Vector3<S> u = F.col(2).normalized();
        Matrix3<S> expected = Matrix3<S>::Zero();
        expected.col(2) = (a - u * u.dot(a)) / F.col(2).norm();
        check_equal<S>(gradient<S>(unit.dot(a.template cast<D>())), expected);
    }
}

TEST_CASE_TEMPLATE("nested duals give the Hessian of the determinant", S, float, double) {
    // d^2 det F / dF_ij dF_kl = eps_ikm eps_jln F_mn
    using D = Dual<S, 9>;
    const Matrix3<S> F = sample_matrix<S>();
    Matrix3<Dual<D, 9>> G;
    for (int k = 0; k < 9; ++k) {
        G.data()[k] = Dual<D, 9>::variable(D::variable(F.data()[k], k), k);
    }
    const Dual<D, 9> J = G.determinant();
    const auto permutation = [](int i, int j, int k) { return S((j - i) * (k - i) * (k - j)) / 2; };
    for (int column = 0; column < 9; ++column) {
        for (int row = 0; row < 9; ++row) {
            const int i = row % 3, j = row / 3, k = column % 3, l = column / 3;
            S expected = 0;
            for (int m = 0; m < 3; ++m) {
                for (int n = 0; n < 3; ++n) {
                    expected += permutation(i, k, m) * permutation(j, l, n) * F(m, n);
                }
            }
            CHECK(double(J.derivative[std::size_t(column)].derivative[std::size_t(row)]) ==
                  doctest::Approx(double(expected)).epsilon(8 * double(std::numeric_limits<S>::epsilon())));
        }
    }
}
