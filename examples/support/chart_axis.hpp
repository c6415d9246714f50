// SPDX-License-Identifier: MIT
/// @file
/// An axis of a chart: what it shows, linear or logarithmic, and where its lines and labels are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace examples {

/// Takes in values, then finish(), then places.
class ChartAxis {
public:
    struct Tick {
        double value;
        std::string label;  // empty: a thin line without a label
    };

    explicit ChartAxis(bool is_log) : is_log_(is_log) {}

    bool shows(double value) const { return std::isfinite(value) && (!is_log_ || value > 0.0); }

    void include(double value) {
        if (shows(value)) {
            low_ = std::min(low_, value);
            high_ = std::max(high_, value);
        }
    }

    /// Widens an empty or too narrow range; `slack`: share of the range to leave free at both ends.
    void finish(double slack) {
        if (low_ > high_) {
            low_ = is_log_ ? 0.1 : 0.0;
            high_ = 1.0;
        }
        double low = scaled(low_), high = scaled(high_);
        const double least = is_log_ ? 0.1 : std::max(1e-12, 1e-6 * std::abs(high_));
        if (high - low < least) {
            const double half = is_log_ ? 0.2 : (high_ == 0.0 ? 0.5 : 0.1 * std::abs(high_));
            low -= half;
            high += half;
        }
        const double margin = slack * (high - low);
        low_ = unscaled(low - margin);
        high_ = unscaled(high + margin);
    }

    /// 0 at the low end of the axis, 1 at the high one.
    double place(double value) const { return (scaled(value) - scaled(low_)) / (scaled(high_) - scaled(low_)); }

    std::vector<Tick> ticks(int about) const {
        return is_log_ && std::log10(high_ / low_) > 0.7 ? decade_ticks() : even_ticks(about);
    }

private:
    double scaled(double value) const { return is_log_ ? std::log10(value) : value; }
    double unscaled(double value) const { return is_log_ ? std::pow(10.0, value) : value; }

    /// Multiples of 1, 2 or 5 times a power of ten.
    std::vector<Tick> even_ticks(int about) const {
        const double rough = (high_ - low_) / about;
        const double power = std::pow(10.0, std::floor(std::log10(rough)));
        const double lead = rough / power;
        const double step = power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
        std::vector<Tick> ticks;
        for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ + 1e-9 * step; ++k) {
            ticks.push_back({k * step, number(k == 0.0 ? 0.0 : k * step, step)});
        }
        return ticks;
    }

    /// Powers of ten, and what of their multiples there is room for.
    std::vector<Tick> decade_ticks() const {
        const double decades = std::log10(high_ / low_);
        std::vector<Tick> ticks;
        for (int power = int(std::floor(std::log10(low_))); power <= int(std::ceil(std::log10(high_))); ++power) {
            for (int lead = 1; lead < 10; ++lead) {
                const double value = lead * std::pow(10.0, power);
                const bool is_labelled = lead == 1 || (decades < 3.0 && (lead == 2 || lead == 5));
                if (value >= low_ * (1.0 - 1e-9) && value <= high_ * (1.0 + 1e-9) && (is_labelled || decades < 5.0)) {
                    ticks.push_back({value, is_labelled ? number(value, value) : std::string()});
                }
            }
        }
        return ticks;
    }

    /// With as many digits as the step needs.
    static std::string number(double value, double step) {
        char text[40];
        if (value != 0.0 && (std::abs(value) >= 1e5 || std::abs(value) < 9.99e-5)) {
            const int power = int(std::floor(std::log10(std::abs(value)) + 1e-9));
            const int digits = std::max(0, power - int(std::floor(std::log10(step) + 1e-9)));
            std::snprintf(text, sizeof text, "%.*fe%d", digits, value / std::pow(10.0, power), power);
        } else {
            std::snprintf(text, sizeof text, "%.*f", std::max(0, -int(std::floor(std::log10(step) + 1e-9))), value);
        }
        return text;
    }

    bool is_log_;
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
};

}  // namespace examples
