// SPDX-License-Identifier: MIT
/// @file
/// What a person does over time in a walk, a jump and a twist, as formulas for HumanPoser.
///
/// What        human_walk(), human_jump(), human_twist(): a duration and the stance at each moment.
///             All begin and end standing (human_standing), at rest, so that clips can follow each other.
/// Equation    C2 in time: smooth_step (fifth degree) and quintic Hermite pieces; in flight y = y0 + v t - g t^2/2.
/// Shapes      seconds, metres, radians.
/// Tests       tests/unit/model/human_clips_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_poser.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace softtissue {

struct HumanClip {
    double duration;
    HumanStance (*at)(double time);
};

/// Position, velocity and acceleration at one end of a piece of motion.
struct MotionState {
    double position;
    double velocity = 0.0;
    double acceleration = 0.0;
};

/// The polynomial of fifth degree from one state to another within `duration`; its value at `time`.
inline double quintic(const MotionState& from, const MotionState& to, double duration, double time) {
    const double T = duration;
    const double u = time / T;
    const double c1 = from.velocity * T;
    const double c2 = 0.5 * from.acceleration * T * T;
    const double p = to.position - from.position - c1 - c2;
    const double v = to.velocity * T - c1 - 2.0 * c2;
    const double a = to.acceleration * T * T - 2.0 * c2;
    const double c3 = 10.0 * p - 4.0 * v + 0.5 * a;
    const double c4 = -15.0 * p + 7.0 * v - a;
    const double c5 = 6.0 * p - 3.0 * v + 0.5 * a;
    return from.position + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))));
}

/// Relaxed, knees a little bent, arms down.
inline HumanStance human_standing() {
    HumanStance stance;
    stance.root(1) = -0.02;
    for (HumanStance::Arm& arm : stance.arms) {
        arm = {0.50, 0.0, 0.12};
    }
    return stance;
}

namespace detail {

/// Rises at `from`, 1 at `peak`, falls to 0 at `to`.
inline double pulse(double from, double peak, double to, double t) {
    return t < peak ? smooth_step(from, peak, t) : smooth_step(to, peak, t);
}

struct Walk {
    static constexpr int steps = 4;
    static constexpr double step_time = 0.50;
    static constexpr double start = 0.20;  // of the first step
    static constexpr double ramp = 0.60;   // to speed up and to slow down
    static constexpr double speed = 1.05;
    static constexpr double leave = start - 0.10;
    static constexpr double arrive = start + (steps - 0.5) * step_time;
    static constexpr double duration = start + steps * step_time + 0.1;

    /// Integral of smooth_step(0, ramp, t).
    static double ramped(double t) {
        const double u = std::clamp(t / ramp, 0.0, 1.0);
        return ramp * u * u * u * u * (2.5 - 3.0 * u + u * u) + std::max(0.0, t - ramp);
    }
    static double travelled(double t) { return speed * (ramped(t - leave) - ramped(t - (arrive - ramp))); }
    static double speed_share(double t) {
        return smooth_step(leave, leave + ramp, t) - smooth_step(arrive - ramp, arrive, t);
    }

    /// Foot of one side: planted, or in one of its swings.
    static HumanStance::Foot foot(int side, double t) {
        HumanStance::Foot result;
        double z = 0.0;
        for (int k = side; k < steps; k += 2) {
            const double lift_off = start + (k + 0.1) * step_time;
            const double touch_down = start + (k + 0.9) * step_time;
            const double next = travelled(start + (k + 1.5) * step_time);
            const double stride = (next - z) / (2.0 * speed * step_time);  // one for a full stride
            const double u = std::clamp((t - lift_off) / (touch_down - lift_off), 0.0, 1.0);
            const double up = 64.0 * u * u * u * (1.0 - u) * (1.0 - u) * (1.0 - u);
            const double heel = pulse(lift_off - 0.20, lift_off + 0.04, lift_off + 0.28, t);
            const double strike = pulse(touch_down - 0.16, touch_down - 0.02, touch_down + 0.10, t);
            const double pitch = stride * (0.75 * heel - 0.30 * strike);
            result.ball += Vector3<double>(0.0, 0.05 * up + 0.19 * stride * 0.30 * strike,
                                           (next - z) * smooth_step(lift_off, touch_down, t));
            result.pitch += pitch;
            result.toes += stride * 0.75 * pulse(lift_off - 0.20, lift_off + 0.04, lift_off + 0.20, t);
            z = next;
        }
        return result;
    }

    static HumanStance at(double t) {
        HumanStance stance = human_standing();
        const double share = speed_share(t);
        const double lowered = smooth_step(0.0, leave + 0.5 * ramp, t) * smooth_step(duration, arrive - 0.5 * ramp, t);
        const double phase = std::numbers::pi * (t - start) / step_time;  // pi per step
        stance.root +=
            Vector3<double>(-0.020 * share * std::sin(phase),
                            -0.032 * lowered - share * (0.006 + 0.014 * std::cos(2.0 * phase)), travelled(t));
        stance.pelvis = share * Vector3<double>(0.04, 0.09 * std::cos(phase), -0.03 * std::sin(phase));
        stance.spine = share * Vector3<double>(0.0, -0.07 * std::cos(phase), 0.01 * std::sin(phase));
        stance.neck = share * Vector3<double>(-0.02, 0.05 * std::cos(phase), 0.0);
        for (int side = 0; side < 2; ++side) {
            const double swing = share * std::cos(phase) * (side == 0 ? 1.0 : -1.0);
            HumanStance::Arm& arm = stance.arms[size_t(side)];
            arm.swing += 0.45 * swing + 0.05 * share;
            arm.elbow += 0.20 * share + 0.18 * swing;
            stance.feet[size_t(side)] = foot(side, t);
        }
        return stance;
    }
};

struct Jump {
    static constexpr double gravity = 9.81;
    static constexpr double take_off_speed = 2.0;
    static constexpr double flight = 2.0 * take_off_speed / gravity;
    static constexpr double crouch = 0.45;  // ends of the phases, in seconds
    static constexpr double take_off = crouch + 0.32;
    static constexpr double landing = take_off + flight;
    static constexpr double deepest = landing + 0.30;
    static constexpr double duration = deepest + 0.45;
    static constexpr double leaving = 0.11;  // the feet take that long to follow the body into the air

    static constexpr double standing_height = -0.02;
    static constexpr double take_off_height = -0.01;

    static double flying(double t) { return take_off_speed * t - 0.5 * gravity * t * t; }

    static double height(double t) {
        const MotionState low{-0.30};
        const MotionState leave{take_off_height, take_off_speed, -gravity};
        const MotionState land{take_off_height, -take_off_speed, -gravity};
        const MotionState lowest{-0.26};
        const MotionState stand{standing_height};
        if (t < crouch) {
            return quintic(stand, low, crouch, t);
        }
        if (t < take_off) {
            return quintic(low, leave, take_off - crouch, t - crouch);
        }
        if (t < landing) {
            return take_off_height + flying(t - take_off);
        }
        return t < deepest ? quintic(land, lowest, deepest - landing, t - landing)
                           : quintic(lowest, stand, duration - deepest, t - deepest);
    }

    /// Height of the feet: they follow the body, a little late, so that they leave and meet the floor softly.
    static double foot_height(double t) {
        const double u = std::min(t - take_off, landing - t);
        if (u <= 0.0) {
            return 0.0;
        }
        constexpr double lag = 0.035;
        const MotionState joined{flying(leaving) - lag, take_off_speed - gravity * leaving, -gravity};
        return u < leaving ? quintic({0.0}, joined, leaving, u) : flying(u) - lag;
    }

    static HumanStance at(double t) {
        HumanStance stance = human_standing();
        const double down = pulse(0.0, crouch, take_off, t);
        const double soft = pulse(landing, deepest, duration, t);
        const double bent = down + 0.8 * soft;
        stance.root = {0.0, height(t), -0.10 * bent};
        stance.pelvis(0) = 0.42 * bent;
        stance.spine(0) = 0.12 * bent;
        stance.neck(0) = -0.16 * bent;
        const double up =
            smooth_step(crouch + 0.02, take_off + 0.10, t) * smooth_step(deepest + 0.05, landing - 0.12, t);
        for (HumanStance::Arm& arm : stance.arms) {
            arm.swing += -0.75 * down + 2.0 * up;
            arm.lower += 0.1 * down - 0.15 * up;
            arm.elbow += 0.35 * bent + 0.3 * up;
        }
        const double heel =
            smooth_step(crouch + 0.10, take_off + 0.04, t) * smooth_step(landing + 0.12, landing - 0.10, t);
        for (HumanStance::Foot& foot : stance.feet) {
            foot.ball(1) = foot_height(t);
            foot.pitch = 0.85 * heel;
            foot.toes = 0.85 * pulse(crouch + 0.10, take_off + 0.04, take_off + 0.20, t) +
                        0.5 * pulse(landing - 0.16, landing - 0.02, landing + 0.12, t);
        }
        return stance;
    }
};

struct Twist {
    static constexpr double duration = 1.7;
    static constexpr double ramp = 0.45;
    static constexpr double frequency = 1.15;

    static HumanStance at(double t) {
        HumanStance stance = human_standing();
        const double share = smooth_step(0.0, ramp, t) * smooth_step(duration, duration - ramp, t);
        const double phase = 2.0 * std::numbers::pi * frequency * (t - 0.5 * duration);
        const double trunk = share * std::sin(phase);
        const double lagging = share * std::sin(phase - 0.5);
        stance.root += Vector3<double>(0.02 * trunk, -0.06 * share, -0.02 * share);
        stance.pelvis = {0.08 * share, 0.30 * trunk, 0.0};
        stance.spine = {0.03 * share, 0.20 * lagging, 0.03 * trunk};
        stance.neck = {-0.06 * share, -0.15 * trunk, 0.0};
        for (int side = 0; side < 2; ++side) {
            const double outside = side == 0 ? 1.0 : -1.0;
            HumanStance::Arm& arm = stance.arms[size_t(side)];
            arm.lower -= 0.62 * share;
            arm.swing += 0.20 * share - 0.35 * outside * share * std::sin(phase - 0.9);
            arm.elbow += 0.50 * share + 0.2 * lagging * outside;
        }
        return stance;
    }
};

}  // namespace detail

/// Four steps forwards, left foot first.
inline HumanClip human_walk() {
    return {detail::Walk::duration, &detail::Walk::at};
}

/// Crouch, flight of 0.41 s, landing.
inline HumanClip human_jump() {
    return {detail::Jump::duration, &detail::Jump::at};
}

/// Turns to both sides, arms flung out.
inline HumanClip human_twist() {
    return {detail::Twist::duration, &detail::Twist::at};
}

}  // namespace softtissue
