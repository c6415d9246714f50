// SPDX-License-Identifier: MIT
/// @file
/// How far to go along a Newton step: all of it, less where the energy rises, farther where it falls like an exponential.
///
/// What        the length of a step, from energies along it
/// Method      length 1; halved until the energy decreases enough (Armijo). Where the whole step more than halves a positive
///             energy, with a decrease of more than `exponential_ratio` times the one that the quadratic model predicted, the length
///             is doubled as long as the energy decreases.
/// Why         With energy exp(Q), Q a square, nearly all curvature along the step is that of the exponential. Every step
///             lowers Q by one only, however large Q is, and the energy to 1/e: 2 (1 - 1/e) = 1.264 times the predicted decrease.
///             The direction is that of the minimum, just the length is short, by 1 + 2 Q. A step in x^4, the growth of
///             polynomial laws, decreases (3/2) (1 - (2/3)^4) = 1.204 times as much as predicted: its length is left alone.
/// Valid       an accepted energy is never above the one at the start by more than its round-off
/// Refuses     nothing: outcomes are values. Energies that are not finite are no decrease.
/// Source      Nocedal & Wright 2006, eq. (3.4), alg. 3.1
/// Departs     lengths beyond one
/// Cost        one energy, one more for each halving or doubling
/// Tests       tests/unit/solver/line_search_test.cpp
#pragma once

#include <softtissue/core/scalar.hpp>

#include <cmath>
#include <limits>

namespace softtissue {

struct LineSearchOptions {
    int max_halvings = 40;
    int max_doublings = 20;  ///< 0: never beyond the step
};

enum class LineSearchOutcome {
    decreased,
    below_resolution,  ///< taken, though the predicted decrease is lost in the rounding of the energy
    none               ///< no length decreases the energy
};

template <RealScalar S>
struct [[nodiscard]] LineSearchResult {
    LineSearchOutcome outcome = LineSearchOutcome::none;
    S length = S(0);           ///< in steps
    S energy = S(0);           ///< there
    S predicted_ratio = S(0);  ///< decrease over the one predicted, before any doubling
};

namespace detail {

/// Between those of x^4 and of exp(x).
template <RealScalar S>
inline constexpr S exponential_ratio = S(1.22);

}  // namespace detail

/// `energy_at(length)` is the energy at that length of the step; at 0 it is `energy` with the derivative `slope` (<= 0).
template <RealScalar S, class EnergyAt>
LineSearchResult<S> search_line(const EnergyAt& energy_at, S energy, S slope, const LineSearchOptions& options = {}) {
    // the energy is a sum over many cells: differences below this are noise
    const S resolution = S(32) * std::numeric_limits<S>::epsilon() * std::abs(energy);
    const S sufficient_decrease = S(1e-4);
    S length(1);
    for (int halving = 0; halving <= options.max_halvings; ++halving, length *= S(0.5)) {
        S lowest = energy_at(length);
        const bool is_resolved = -length * slope > resolution;
        if (!(lowest <= energy + sufficient_decrease * length * slope + (is_resolved ? S(0) : resolution))) {
            continue;
        }
        const S ratio = (lowest - energy) / (slope * (length - length * length / S(2)));
        const bool is_exponential = halving == 0 && is_resolved && ratio > detail::exponential_ratio<S> &&
                                    lowest > S(0) && lowest < energy / S(2);
        for (int doubling = 0; is_exponential && doubling < options.max_doublings; ++doubling) {
            const S farther = energy_at(S(2) * length);
            if (!(farther < lowest)) {
                break;
            }
            lowest = farther;
            length *= S(2);
        }
        return {is_resolved ? LineSearchOutcome::decreased : LineSearchOutcome::below_resolution, length, lowest,
                ratio};
    }
    return {};
}

}  // namespace softtissue
