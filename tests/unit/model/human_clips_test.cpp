// SPDX-License-Identifier: MIT
#include <softtissue/model/human_clips.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace softtissue;

namespace {

/// All numbers of a stance in a row.
VectorX<double> numbers(const HumanStance& s) {
    VectorX<double> v(28);
    v << s.root, s.pelvis, s.spine, s.neck, s.arms[0].lower, s.arms[0].swing, s.arms[0].elbow, s.arms[1].lower,
        s.arms[1].swing, s.arms[1].elbow, s.feet[0].ball, s.feet[0].pitch, s.feet[0].toes, s.feet[1].ball,
        s.feet[1].pitch, s.feet[1].toes;
    return v;
}

std::array<HumanClip, 3> clips() {
    return {human_walk(), human_jump(), human_twist()};
}

}  // namespace

TEST_CASE("quintic: meets both ends in position, velocity and acceleration") {
    const MotionState from{0.2, 1.0, -3.0};
    const MotionState to{-0.1, 0.5, 4.0};
    const double T = 0.7;
    const double h = 1e-4;
    const auto f = [&](double t) { return quintic(from, to, T, t); };
    CHECK(f(0.0) == doctest::Approx(0.2));
    CHECK(f(T) == doctest::Approx(-0.1));
    // Central differences of a polynomial: errors h^2 times its third and fourth derivative (below 1e3 and 1e4).
    CHECK(std::abs((f(h) - f(-h)) / (2.0 * h) - 1.0) < 1e-5);
    CHECK(std::abs((f(T + h) - f(T - h)) / (2.0 * h) - 0.5) < 1e-5);
    CHECK(std::abs((f(h) - 2.0 * f(0.0) + f(-h)) / (h * h) + 3.0) < 1e-3);
    CHECK(std::abs((f(T + h) - 2.0 * f(T) + f(T - h)) / (h * h) - 4.0) < 1e-3);
}

TEST_CASE("clips: begin and end standing, wherever they have gone") {
    for (const HumanClip& clip : clips()) {
        const VectorX<double> standing = numbers(human_standing());
        CHECK((numbers(clip.at(0.0)) - standing).cwiseAbs().maxCoeff() < 1e-12);
        HumanStance end = clip.at(clip.duration);
        const double gone = end.root(2);
        for (auto& foot : end.feet) {
            foot.ball(2) -= gone;
        }
        end.root(2) -= gone;
        CHECK((numbers(end) - standing).cwiseAbs().maxCoeff() < 1e-12);
        // At rest: what moves like t^3 stays below 1e5 t^3.
        CHECK((numbers(clip.at(1e-4)) - standing).cwiseAbs().maxCoeff() < 1e-7);
    }
    CHECK(human_walk().at(human_walk().duration).root(2) > 1.2);
}

TEST_CASE("clips: accelerations are continuous") {
    for (const HumanClip& clip : clips()) {
        const auto largest_change = [&clip](double h) {
            double result = 0.0;
            VectorX<double> previous;
            for (double t = 2.0 * h; t < clip.duration - 2.0 * h; t += h) {
                const VectorX<double> a =
                    (numbers(clip.at(t + h)) - 2.0 * numbers(clip.at(t)) + numbers(clip.at(t - h))) / (h * h);
                if (previous.size() > 0) {
                    result = std::max(result, (a - previous).cwiseAbs().maxCoeff());
                }
                previous = a;
            }
            return result;
        };
        // From one sample to the next a continuous acceleration changes in proportion to h, one with a step does not.
        CHECK(largest_change(4e-4) > 1.8 * largest_change(2e-4));
    }
}

TEST_CASE("clips: feet within reach, and not below the floor") {
    const HumanPoser poser(human_rest_joints());
    for (const HumanClip& clip : clips()) {
        for (double t = 0.0; t <= clip.duration; t += 2e-3) {
            const HumanStance stance = clip.at(t);
            for (Index side = 0; side < 2; ++side) {
                CHECK(poser.reach(stance, side) < 0.993);
                CHECK(stance.feet[size_t(side)].ball(1) >= 0.0);
            }
        }
    }
}

TEST_CASE("jump: the pelvis flies on a parabola") {
    const HumanClip jump = human_jump();
    const double h = 1e-3;
    int airborne = 0;
    for (double t = h; t < jump.duration - h; t += h) {
        if (jump.at(t - h).feet[0].ball(1) > 0.0 && jump.at(t + h).feet[0].ball(1) > 0.0) {
            const double a = (jump.at(t + h).root(1) - 2.0 * jump.at(t).root(1) + jump.at(t - h).root(1)) / (h * h);
            CHECK(a == doctest::Approx(-9.81).epsilon(1e-6));
            ++airborne;
        }
    }
    CHECK(airborne > 380);
    CHECK(airborne < 410);
}
