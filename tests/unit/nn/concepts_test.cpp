// SPDX-License-Identifier: MIT
#include <softtissue/nn/concepts.hpp>

#include <softtissue/nn/gelu.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

struct Square {
    template <class S>
    static ActivationValue<S> at(S x) {
        return {x * x, 2 * x};
    }
};
struct WithState : Square {
    int state;
};
struct OnlyDouble {
    static ActivationValue<double> at(double x) { return {x, 1}; }
};
struct ValueAlone {
    template <class S>
    static S at(S x) {
        return x;
    }
};

static_assert(Activation<Gelu> && Activation<TanhGelu> && Activation<Square>);
static_assert(!Activation<WithState> && !Activation<OnlyDouble> && !Activation<ValueAlone> && !Activation<int>);

}  // namespace

TEST_CASE("an activation of one's own") {
    CHECK(Square::at(3.0).slope == 6);
}
