// SPDX-License-Identifier: MIT
/// @file
/// The design of the procedural human: its joints, and its surface as the zero of one smooth function.
///
/// What        24 joints of SMPL in an A-pose (arms 48 degrees below the horizontal, elbows bent forward by 8,
///             feet 0.27 m apart), and a solid around them melted from tubes, capsules and ellipsoids.
/// Shapes      rest_joints() 3 x 24 [m]; HumanSolid()(x) [m], negative inside.
///             y up, facing +z, left = +x; mirror symmetric about x = 0; the soles lie on y = 0.
/// Why A-pose  the armpit is open and the shoulder half way between its extremes: layers shrunk inwards from the
///             skin meet no fold there, and neither raising nor lowering the arm stretches it by more than 90 degrees.
/// Source      proportions of a 1.73 m adult after common anthropometric tables (breadths, depths, girths).
/// Tests       tests/unit/model/human_solid_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/smooth_solid.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace softtissue {

/// Joint numbers of SMPL, left side; the right one is the next number.
namespace human_joint {
inline constexpr Index pelvis = 0, hip = 1, spine1 = 3, knee = 4, spine2 = 6, ankle = 7, spine3 = 9, foot = 10;
inline constexpr Index neck = 12, collar = 13, head = 15, shoulder = 16, elbow = 18, wrist = 20, hand = 22;
inline constexpr Index count = 24;
}  // namespace human_joint

inline std::vector<std::int32_t> human_parents() {
    return {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
}

inline std::vector<std::string> human_joint_names() {
    return {"pelvis",     "left_hip",    "right_hip",    "spine1",      "left_knee",     "right_knee",
            "spine2",     "left_ankle",  "right_ankle",  "spine3",      "left_foot",     "right_foot",
            "neck",       "left_collar", "right_collar", "head",        "left_shoulder", "right_shoulder",
            "left_elbow", "right_elbow", "left_wrist",   "right_wrist", "left_hand",     "right_hand"};
}

/// The same joint of the other side; itself on the mid-line.
inline Index mirror_joint(Index joint) {
    constexpr std::array<int, human_joint::count> mirrored{0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11, 10,
                                                           12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};
    return mirrored[size_t(joint)];
}

inline Vector3<double> mirrored(const Vector3<double>& x) {
    return {-x(0), x(1), x(2)};
}

/// Rest positions of the joints, 3 x 24.
inline Matrix3X<double> human_rest_joints() {
    using namespace human_joint;
    Matrix3X<double> J(3, count);
    const auto middle = [&](Index j, double y, double z) { J.col(j) << 0.0, y, z; };
    const auto pair = [&](Index j, const Vector3<double>& x) {
        J.col(j) = x;
        J.col(j + 1) = mirrored(x);
    };
    middle(pelvis, 0.960, -0.010);
    middle(spine1, 1.070, -0.018);
    middle(spine2, 1.185, -0.028);
    middle(spine3, 1.290, -0.034);
    middle(neck, 1.468, -0.035);
    middle(head, 1.555, -0.015);
    pair(hip, {0.088, 0.900, -0.004});
    pair(knee, {0.113, 0.488, 0.002});
    pair(ankle, {0.133, 0.082, -0.028});
    pair(foot, {0.148, 0.022, 0.098});
    pair(collar, {0.060, 1.395, -0.025});
    const Vector3<double> shoulder_at(0.176, 1.408, -0.034);
    const Vector3<double> arm(0.669, -0.743, 0.0);                                      // 48 degrees down
    const Vector3<double> forearm = Vector3<double>(0.669, -0.743, 0.14).normalized();  // elbow bent by 8 degrees
    pair(shoulder, shoulder_at);
    pair(elbow, shoulder_at + 0.275 * arm);
    pair(wrist, shoulder_at + 0.275 * arm + 0.250 * forearm);
    pair(hand, shoulder_at + 0.275 * arm + 0.340 * forearm);
    return J;
}

/// The body as a signed distance.
class HumanSolid {
public:
    HumanSolid() : HumanSolid(human_rest_joints()) {}

    double operator()(const Vector3<double>& x) const {
        const Vector3<double> y = mirrored(x);
        double d = smooth_union(trunk(x, y), smooth_union(leg(x), leg(y), 0.03), 0.07);
        d = smooth_union(d, head_and_neck(x, y), 0.03);
        return smooth_union(d, std::min(arm(x), arm(y)), 0.05);
    }

private:
    static constexpr double far_away = 0.1;  // wider than any blend: parts that far away are not evaluated

    explicit HumanSolid(const Matrix3X<double>& J)
        : trunk_({0.0, 0.80, 0.0}, {0.0, 1.50, 0.0}, {0.0, 0.0, 1.0}, trunk_sections(), 0.75),
          chest_{{0.070, 1.300, 0.046}, {0.084, 0.072, 0.042}},
          slope_{{0.020, 1.478, -0.040}, {0.150, 1.425, -0.038}, 0.040, 0.038},
          buttock_{{0.075, 0.892, -0.058}, {0.085, 0.098, 0.074}},
          thigh_(J.col(human_joint::hip), J.col(human_joint::knee), {0.0, 0.0, 1.0}, thigh_sections()),
          shank_(J.col(human_joint::knee), J.col(human_joint::ankle), {0.0, 0.0, 1.0}, shank_sections()),
          upper_arm_(J.col(human_joint::shoulder), J.col(human_joint::elbow), {0.0, 0.0, 1.0}, upper_arm_sections()),
          forearm_(J.col(human_joint::elbow), J.col(human_joint::wrist), {0.0, 0.0, 1.0}, forearm_sections()),
          hand_(J.col(human_joint::wrist), J.col(human_joint::hand), {0.0, 0.0, 1.0}, hand_sections()),
          thumb_(thumb(J)) {}

    double trunk(const Vector3<double>& x, const Vector3<double>& y) const {
        if (x(1) < 0.68 || x(1) > 1.62) {
            return far_away;
        }
        double d = smooth_union(trunk_.distance(x), smooth_union(chest_.distance(x), chest_.distance(y), 0.04), 0.05);
        d = smooth_union(d, smooth_union(slope_.distance(x), slope_.distance(y), 0.03), 0.035);
        return smooth_union(d, smooth_union(buttock_.distance(x), buttock_.distance(y), 0.05), 0.06);
    }

    double leg(const Vector3<double>& x) const {
        if (x(0) < -0.1 || x(1) > 1.05) {
            return far_away;
        }
        const double limb = smooth_union(thigh_.distance(x), shank_.distance(x), 0.03);
        return x(1) > 0.25 ? limb : smooth_union(limb, foot(x), 0.03);
    }

    double foot(const Vector3<double>& x) const {
        const double upper = smooth_union(heel_.distance(x), instep_.distance(x), 0.03);
        const double front = smooth_union(ball_.distance(x), toes_.distance(x), 0.02);
        const double whole = smooth_union(smooth_union(upper, sole_.distance(x), 0.02), front, 0.03);
        return smooth_intersection(whole, -x(1), 0.016);
    }

    double arm(const Vector3<double>& x) const {
        if (x(0) < 0.02 || x(1) < 0.78) {
            return far_away;
        }
        const double limb = smooth_union(upper_arm_.distance(x), forearm_.distance(x), 0.02);
        return smooth_union(limb, smooth_union(hand_.distance(x), thumb_.distance(x), 0.014), 0.02);
    }

    double head_and_neck(const Vector3<double>& x, const Vector3<double>& y) const {
        if (x(1) < 1.30) {
            return far_away;
        }
        double d = smooth_union(cranium_.distance(x), face_.distance(x), 0.03);
        d = smooth_union(d, jaw_.distance(x), 0.025);
        d = smooth_union(d, chin_.distance(x), 0.02);
        d = smooth_union(d, smooth_union(cheek_.distance(x), cheek_.distance(y), 0.02), 0.025);
        d = smooth_union(d, lips_.distance(x), 0.012);
        d = smooth_intersection(d, -std::min(eye_socket_.distance(x), eye_socket_.distance(y)), 0.018);
        d = smooth_union(d, smooth_union(eye_.distance(x), eye_.distance(y), 0.01), 0.006);
        d = smooth_union(d, nose_.distance(x), 0.014);
        d = smooth_union(d, std::min(ear_.distance(x), ear_.distance(y)), 0.01);
        return smooth_union(d, neck_.distance(x), 0.025);
    }

    // t is the height between 0.80 and 1.50 m; the columns are metres.
    static std::vector<TubeSection> trunk_sections() {
        return {{0.03, 0.050, 0.050, 0.058, 0.050, 0.000},  {0.09, 0.096, 0.096, 0.082, 0.076, -0.002},
                {0.17, 0.148, 0.148, 0.102, 0.094, -0.004}, {0.26, 0.167, 0.167, 0.110, 0.096, -0.004},
                {0.34, 0.153, 0.153, 0.108, 0.088, -0.002}, {0.42, 0.139, 0.139, 0.104, 0.082, -0.002},
                {0.50, 0.136, 0.136, 0.102, 0.084, -0.004}, {0.60, 0.144, 0.144, 0.106, 0.094, -0.010},
                {0.70, 0.153, 0.153, 0.110, 0.102, -0.016}, {0.78, 0.156, 0.156, 0.102, 0.104, -0.022},
                {0.86, 0.142, 0.142, 0.080, 0.090, -0.030}, {0.93, 0.100, 0.100, 0.058, 0.070, -0.034},
                {0.98, 0.062, 0.062, 0.048, 0.056, -0.034}};
    }
    static std::vector<TubeSection> thigh_sections() {
        return {{-0.10, 0.080, 0.060, 0.075, 0.070},        {0.05, 0.088, 0.076, 0.086, 0.084, -0.002},
                {0.18, 0.087, 0.080, 0.088, 0.084, -0.004}, {0.35, 0.080, 0.076, 0.085, 0.078, -0.004},
                {0.55, 0.068, 0.067, 0.074, 0.067},         {0.75, 0.058, 0.059, 0.063, 0.056},
                {0.90, 0.052, 0.053, 0.056, 0.049},         {1.00, 0.049, 0.051, 0.053, 0.047}};
    }
    static std::vector<TubeSection> shank_sections() {
        return {{-0.04, 0.048, 0.050, 0.052, 0.047},        {0.08, 0.049, 0.051, 0.048, 0.052},
                {0.20, 0.051, 0.053, 0.044, 0.062, -0.004}, {0.32, 0.051, 0.053, 0.042, 0.064, -0.006},
                {0.48, 0.044, 0.046, 0.039, 0.052, -0.004}, {0.65, 0.036, 0.037, 0.036, 0.040},
                {0.82, 0.031, 0.031, 0.033, 0.036},         {0.94, 0.032, 0.031, 0.034, 0.038},
                {1.02, 0.033, 0.033, 0.036, 0.040}};
    }
    static std::vector<TubeSection> upper_arm_sections() {
        return {{-0.06, 0.046, 0.040, 0.046, 0.046}, {0.05, 0.056, 0.046, 0.054, 0.054},
                {0.20, 0.056, 0.047, 0.054, 0.054},  {0.36, 0.049, 0.046, 0.051, 0.050},
                {0.55, 0.043, 0.044, 0.049, 0.045},  {0.75, 0.039, 0.039, 0.044, 0.041},
                {0.90, 0.037, 0.036, 0.039, 0.038},  {1.00, 0.037, 0.036, 0.038, 0.037}};
    }
    static std::vector<TubeSection> forearm_sections() {
        return {{-0.03, 0.037, 0.036, 0.038, 0.036}, {0.12, 0.040, 0.039, 0.041, 0.039},
                {0.28, 0.040, 0.039, 0.041, 0.039},  {0.50, 0.033, 0.033, 0.036, 0.034},
                {0.72, 0.027, 0.026, 0.031, 0.030},  {0.90, 0.022, 0.022, 0.028, 0.028},
                {1.00, 0.021, 0.021, 0.028, 0.028}};
    }
    // t = 1 is the hand joint, 0.09 m from the wrist; the finger tips are at 0.185 m.
    static std::vector<TubeSection> hand_sections() {
        return {{-0.05, 0.020, 0.020, 0.027, 0.027},     {0.25, 0.016, 0.020, 0.034, 0.033},
                {0.60, 0.015, 0.018, 0.041, 0.038},      {1.00, 0.014, 0.016, 0.042, 0.040},
                {1.45, 0.012, 0.013, 0.038, 0.038, 0.0}, {1.80, 0.010, 0.011, 0.031, 0.033, 0.0},
                {1.96, 0.009, 0.009, 0.022, 0.024, 0.0}};
    }
    static TaperedCapsule thumb(const Matrix3X<double>& J) {
        const Vector3<double> wrist = J.col(human_joint::wrist);
        const Vector3<double> along = (J.col(human_joint::hand) - J.col(human_joint::wrist)).normalized();
        const Vector3<double> front = Vector3<double>::UnitZ();
        const Vector3<double> palm(-along(1), along(0), 0.0);  // towards the back of the hand
        return {wrist + 0.028 * along + 0.020 * front - 0.006 * palm,
                wrist + 0.098 * along + 0.060 * front - 0.012 * palm, 0.016, 0.0105};
    }

    Tube trunk_;
    Ellipsoid chest_;
    TaperedCapsule slope_;
    Ellipsoid buttock_;
    Tube thigh_;
    Tube shank_;
    Tube upper_arm_;
    Tube forearm_;
    Tube hand_;
    TaperedCapsule thumb_;
    Ellipsoid heel_{{0.134, 0.036, -0.052}, {0.032, 0.048, 0.040}};
    TaperedCapsule instep_{{0.134, 0.068, -0.015}, {0.147, 0.028, 0.085}, 0.038, 0.028};
    TaperedCapsule sole_{{0.136, 0.014, -0.050}, {0.150, 0.012, 0.080}, 0.028, 0.034};
    Ellipsoid ball_{{0.148, 0.020, 0.090}, {0.046, 0.028, 0.055}};
    Ellipsoid toes_{{0.151, 0.012, 0.135}, {0.041, 0.021, 0.048}};
    TaperedCapsule neck_{{0.0, 1.430, -0.032}, {0.0, 1.565, -0.012}, 0.061, 0.056};
    Ellipsoid cranium_{{0.0, 1.640, -0.004}, {0.077, 0.092, 0.096}};
    Ellipsoid face_{{0.0, 1.585, 0.030}, {0.062, 0.082, 0.066}};
    Ellipsoid jaw_{{0.0, 1.545, 0.036}, {0.050, 0.040, 0.052}};
    Ellipsoid chin_{{0.0, 1.519, 0.070}, {0.024, 0.020, 0.022}};
    Ellipsoid cheek_{{0.034, 1.585, 0.062}, {0.026, 0.022, 0.026}};
    Ellipsoid lips_{{0.0, 1.549, 0.086}, {0.023, 0.009, 0.012}};
    Ellipsoid eye_socket_{{0.032, 1.618, 0.103}, {0.019, 0.011, 0.018}};
    Ellipsoid eye_{{0.031, 1.617, 0.074}, {0.014, 0.011, 0.014}};
    TaperedCapsule nose_{{0.0, 1.622, 0.088}, {0.0, 1.588, 0.103}, 0.007, 0.0115};
    Ellipsoid ear_{{0.078, 1.605, -0.002}, {0.010, 0.031, 0.018}};
};

}  // namespace softtissue
