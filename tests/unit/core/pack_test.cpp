// SPDX-License-Identifier: MIT
#include <softtissue/core/pack.hpp>

#include <softtissue/core/notation.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <type_traits>
#include <vector>

using namespace softtissue;

static_assert(FieldScalar<Pack<float, 4>> && RealLanes<Pack<double, 2>> && RealLanes<float>);
static_assert(!RealScalar<Pack<float, 4>> && !HasPlainValue<Pack<float, 4>> && HasPlainValue<double>);
static_assert(std::same_as<RealOf<Pack<float, 4>>, float> && num_lanes<Pack<float, 4>> == 4 && num_lanes<double> == 1);
static_assert(std::is_trivially_copyable_v<Pack<double, 2>>);
static_assert(sizeof(Pack<float, natural_lanes<float>>) == sizeof(float) * natural_lanes<float>);
static_assert(std::convertible_to<int, Pack<float, 4>> && !std::convertible_to<Pack<float, 4>, float>);

namespace {

template <class P>
using Real = RealOf<P>;

/// Numbers with both signs, zeros of both signs, subnormal and infinite ones.
template <class P>
P numbers(int shift) {
    using Limits = std::numeric_limits<Real<P>>;
    const std::vector<Real<P>> list{Real<P>(1.5),         Real<P>(-2),        Real<P>(0),    Real<P>(-0.0),
                                    Limits::denorm_min(), Limits::infinity(), Limits::max(), Real<P>(-7)};
    return P::from_lanes([&](int i) { return list[size_t(i + shift) % list.size()]; });
}

template <class T>
bool is_same(T a, T b) {
    return a == b ? std::signbit(a) == std::signbit(b) : a != a && b != b;
}

}  // namespace

// Packs that fill a register, packs wider than any register, and packs that are no power of two.
TEST_CASE_TEMPLATE("every operation acts on each lane as on a plain number", P, Pack<float, natural_lanes<float>>,
                   Pack<double, natural_lanes<double>>, Pack<float, 64>, Pack<double, 3>, Pack<float, 1>) {
    constexpr int N = num_lanes<P>;
    for (int shift = 0; shift < 8; ++shift) {
        const P a = numbers<P>(0);
        const P b = numbers<P>(shift);
        const auto less = a<b, less_equal = a <= b, greater = a> b, greater_equal = a >= b, equal = a == b,
                   differ = a != b;
        const P sum = a + b, difference = a - b, product = a * b, quotient = a / b, negative = -a;
        const P chosen = select(less | (equal & !differ), a, b);
        for (int i = 0; i < N; ++i) {
            CHECK(is_same(sum[i], a[i] + b[i]));
            CHECK(is_same(difference[i], a[i] - b[i]));
            CHECK(is_same(product[i], a[i] * b[i]));
            CHECK(is_same(quotient[i], a[i] / b[i]));
            CHECK(is_same(negative[i], -a[i]));
            CHECK(less[i] == (a[i] < b[i]));
            CHECK(less_equal[i] == (a[i] <= b[i]));
            CHECK(greater[i] == (a[i] > b[i]));
            CHECK(greater_equal[i] == (a[i] >= b[i]));
            CHECK(equal[i] == (a[i] == b[i]));
            CHECK(differ[i] == (a[i] != b[i]));
            CHECK(is_same(chosen[i], a[i] < b[i] || a[i] == b[i] ? a[i] : b[i]));
        }
    }
    P x = numbers<P>(0);
    x += P(2);
    x *= 3;
    x -= 1;
    x /= 2;
    CHECK(x[0] == ((Real<P>(1.5) + 2) * 3 - 1) / 2);
    CHECK(std::signbit(P(-0.0)[0]));
}

TEST_CASE("memory of any alignment") {
    using P = Pack<float, natural_lanes<float>>;
    std::vector<float> memory(size_t(2 * num_lanes<P> + 3), 0.0F);
    for (size_t i = 0; i < memory.size(); ++i) {
        memory[i] = float(i);
    }
    const P x = P::load(memory.data() + 1);
    CHECK(x[0] == 1.0F);
    x.store(memory.data() + 2);
    CHECK(memory[2] == 1.0F);
    CHECK(memory[size_t(num_lanes<P>) + 1] == float(num_lanes<P>));
}

TEST_CASE_TEMPLATE("matrices of packs are packs of matrices", S, float, double) {
    constexpr int N = natural_lanes<S>;
    const auto plain = [](int i) {
        Matrix3<S> M;
        M << S(1), S(2 + i), S(3), S(0.5), S(-1), S(i), S(7), S(0), S(2);
        return M;
    };
    const Matrix3<Pack<S, N>> A = packed_matrix<N>(plain);
    const Matrix3<Pack<S, N>> B = (A * A.transpose() - Matrix3<Pack<S, N>>::Identity()) * Pack<S, N>(2);
    const Pack<S, N> norm = A.squaredNorm();
    const Pack<S, N> trace = A.trace();
    for (int i = 0; i < N; ++i) {
        const Matrix3<S> M = plain(i);
        CHECK(lane(A, i) == M);
        CHECK((lane(B, i) - S(2) * (M * M.transpose() - Matrix3<S>::Identity())).cwiseAbs().maxCoeff() <
              S(200) * std::numeric_limits<S>::epsilon());
        CHECK(double(norm[i]) == doctest::Approx(double(M.squaredNorm())));
        CHECK(lane(trace, i) == M.trace());
    }
    CHECK(lane(S(3), 0) == S(3));
}
