// SPDX-License-Identifier: MIT
/// @file
/// The bones of trunk, shoulder girdle and pelvis.
///
/// What        TrunkBones: paired() collar bone, shoulder blade, hip bone, twelve ribs of the left half; middle() sternum,
///             vertebrae from the loin (1) up to the neck (21), sacrum.
/// Source      a design after anatomical plates: suggestive, not measured.
/// Tests       tests/unit/model/trunk_bones_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>
#include <softtissue/model/bone_lofts.hpp>
#include <softtissue/model/human_solid.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

class TrunkBones : private BoneLofts {
public:
    using BoneLofts::BoneLofts;

    std::vector<AnatomyMesh<double>> paired() {
        shoulder_girdle();
        hip_bone();
        for (int i = 0; i < 12; ++i) {
            rib(i);
        }
        return take();
    }

    std::vector<AnatomyMesh<double>> middle() {
        sternum();
        for (int i = 0; i < num_vertebrae; ++i) {
            vertebra(i);
        }
        sacrum();
        return take();
    }

private:
    static constexpr int num_vertebrae = 21;  // five of the loin, twelve of the chest, four of the neck

    void shoulder_girdle() {
        using namespace human_joint;
        const Vector3<double> S = body_.joint(human_joint::shoulder);
        const Vector3<double> C = body_.joint(collar);
        const Vector3<double> inside = 0.5 * (S + C);
        const double t_sternum = 0.85;
        const Vector3<double> inner_end = chest(t_sternum, 12, 1.0);
        const std::vector<Vector3<double>> path{
            inner_end, inner_end + 0.3 * (S - inner_end) + mm_ * Vector3<double>(0, 5, 10),
            inner_end + 0.65 * (S - inner_end) + mm_ * Vector3<double>(0, 14, -2),
            S + mm_ * Vector3<double>(-8, 17, -4), S + mm_ * Vector3<double>(6, 15, -8)};
        start("clavicle");
        const Vector3<double> along = (S - inner_end).normalized();
        const Vector3<double> up = (Vector3<double>::UnitY() - along(1) * along).normalized();
        const std::vector<Eigen::Vector2d> widths{{8, 8}, {6, 6}, {5.5, 6}, {5, 8.5}, {4.5, 8}};
        tube([&](double u) { return along_stations<3>(path, u); },
             [&](double u) { return along_stations<2>(widths, u); }, up, along.cross(up), inside, 18, 10, 0.08);

        start("scapula");
        // (height above the shoulder [mm], inner and outer angle)
        const std::vector<Vector3<double>> blade{{16, 139, 130},  {6, 142, 118},   {-8, 143, 108},  {-30, 142, 114},
                                                 {-60, 141, 121}, {-90, 140, 128}, {-108, 138, 133}};
        const double to_t = mm_ / trunk_.length();
        const double t_shoulder = (S(1) - trunk_.origin(0.0)(1)) / trunk_.length();
        plate(
            [&](double u) {
                const Vector3<double> row = along_stations<3>(blade, u);
                return PlateRow{t_shoulder + to_t * row(0), 0.5 * (row(1) + row(2)), 0.5 * (row(1) - row(2)), 1.13,
                                3.2};
            },
            18, 18);
        // Spine of the scapula out to the acromion, and the socket.
        const std::vector<Vector3<double>> ridge{
            chest(t_shoulder - 12 * to_t, 141, 1.17), chest(t_shoulder - 2 * to_t, 126, 1.26),
            S + mm_ * Vector3<double>(-14, 10, -22), S + mm_ * Vector3<double>(8, 17, -12)};
        tube([&](double u) { return along_stations<3>(ridge, u); }, [](double) { return Eigen::Vector2d(4, 6); }, up,
             along.cross(up), inside, 12, 8, 0.12);
        const std::vector<Vector3<double>> neck_of_blade{chest(t_shoulder - 8 * to_t, 112, 1.12),
                                                         S + mm_ * Vector3<double>(-20, -4, -8)};
        tube([&](double u) { return along_stations<3>(neck_of_blade, u); },
             [](double u) { return Eigen::Vector2d(7 + 7 * u, 6 + 4 * u); }, up, along.cross(up), inside, 8, 10, 0.2);
    }

    void hip_bone() {
        using namespace human_joint;
        const Vector3<double> H = body_.joint(hip);
        const Vector3<double> P = body_.joint(pelvis);
        start("hip_bone");
        // (t, angle, half width in degrees, radius against the chest's ellipse, half thickness [mm])
        const Stations wing{Station(.150, 100, 26, 1.02, 5), Station(.145, 97, 45, 1.02, 6),
                            Station(.110, 95, 58, .98, 4),   Station(.050, 97, 55, .92, 3.5),
                            Station(-.02, 100, 36, .88, 5),  Station(-.07, 95, 22, .87, 9),
                            Station(-.12, 92, 15, .86, 12)};
        plate(
            [&](double u) {
                const Station s = along_stations<5>(wing, u);
                return PlateRow{s(0), s(1), s(2), s(3), s(4)};
            },
            18, 26);
        const Vector3<double> socket = H + mm_ * Vector3<double>(-4, 4, 0);
        tube([&](double u) { return Vector3<double>(socket + mm_ * 22 * (2 * u - 1) * Vector3<double>::UnitX()); },
             [](double) { return Eigen::Vector2d(27, 27); }, Vector3<double>::UnitY(), Vector3<double>::UnitZ(), P, 8,
             14, 0.5);
        const Vector3<double> symphysis(5 * mm_, H(1) - 18 * mm_, P(2) + 52 * mm_);
        const std::vector<Vector3<double>> ring{symphysis + mm_ * Vector3<double>(0, 8, 0),
                                                socket + Vector3<double>(-.55 * H(0) + 10 * mm_, 8 * mm_, 40 * mm_),
                                                socket + mm_ * Vector3<double>(-4, 6, 18), socket};
        tube([&](double u) { return along_stations<3>(ring, u); },
             [](double u) { return Eigen::Vector2d(8 + 5 * u, 8 + 4 * u); }, Vector3<double>::UnitY(),
             Vector3<double>(1, 0, 1).normalized(), P, 14, 10, 0.12);
        const std::vector<Vector3<double>> lower{
            socket + mm_ * Vector3<double>(-6, -8, -12), socket + mm_ * Vector3<double>(-14, -38, -26),
            socket + mm_ * Vector3<double>(-22, -56, -18), socket + mm_ * Vector3<double>(-42, -46, 12),
            symphysis + mm_ * Vector3<double>(2, -14, 0)};
        const std::vector<Eigen::Vector2d> lower_widths{{14, 14}, {12, 14}, {12, 13}, {6, 8}, {6, 9}};
        tube([&](double u) { return along_stations<3>(lower, u); },
             [&](double u) { return along_stations<2>(lower_widths, u); }, Vector3<double>::UnitX(),
             Vector3<double>(0, 1, 1).normalized(), P, 18, 10, 0.1);
    }

    void rib(int i) {
        start(("rib_" + std::to_string(i + 1)).c_str());
        const double back = 0.915 - 0.046 * i;
        const double low = back - 0.05 - 0.011 * std::min(i, 7);
        const double at_sternum = i < 7 ? 0.835 - 0.036 * i : low + 0.03;
        const double end = i < 7 ? 10.0 : i < 10 ? 22.0 + 9.0 * (i - 7) : 75.0 + 30.0 * (i - 10);
        std::vector<Eigen::Vector2d> path{
            {back, 166}, {back - .1 * (back - low), 148}, {back - .3 * (back - low), 120}};
        if (end < 70) {
            path.insert(path.end(),
                        {{back - .65 * (back - low), 85}, {low, 52}, {0.5 * (low + at_sternum), 30 + 0.3 * end}});
        }
        path.emplace_back(i < 10 ? at_sternum : back - .6 * (back - low), end);
        add_loft(meshes_.back(), count(34), sectors(8), [&](double u, double angle) {
            const double size = rounded_ends(u, 0.03);
            const Eigen::Vector2d place = along_stations<2>(path, u);
            const double t = place(0) + size * mm_ * 5.5 / trunk_.length() * std::cos(angle);
            const Vector3<double> o = trunk_.origin(place(0));
            const Vector3<double> up(0, (t - place(0)) * trunk_.length(), 0);
            const double radius = chest_radius(place(0), place(1)) + size * mm_ * 3.0 * std::sin(angle);
            const Vector3<double> c =
                body_.within_bone(o, o + radius * trunk_.direction(place(1)), (5 - 3 * std::sin(angle)) * mm_);
            return body_.within_bone(c, c + up, mm_);
        });
    }

    void sternum() {
        start("sternum");
        const std::vector<Eigen::Vector2d> rows{{.865, 17}, {.85, 24}, {.82, 20}, {.79, 13},
                                                {.7, 15},   {.63, 16}, {.58, 9},  {.54, 4}};
        plate(
            [&](double u) {
                const Eigen::Vector2d row = along_stations<2>(rows, u);
                const double radius = chest_radius(row(0), 0.0);
                return PlateRow{row(0), 0.0, row(1) * mm_ / radius * 180.0 / std::numbers::pi, 1.0, 4.5};
            },
            20, 14);
    }

    /// Heights of the vertebrae: evenly spread, larger below.
    static double vertebra_height(double i) { return 0.055 + 0.0655 * i - 0.0006 * i * i; }

    /// The middle of the vertebral body.
    Vector3<double> spine(double t) const {
        const Vector3<double> o = trunk_.origin(t);
        const double wanted = 0.42 * 1e3 * mm_ * shape_.half_depth(t);
        return body_.within_bone(o, o - wanted * trunk_.front(), 12 * mm_);
    }

    void vertebra(int i) {
        start(("vertebra_" + std::to_string(i + 1)).c_str());
        const double t = vertebra_height(i);
        const double half = 0.42 * (vertebra_height(i + 0.5) - vertebra_height(i - 0.5)) * trunk_.length();
        const double size = 1.0 - 0.022 * i;
        const Vector3<double> x = Vector3<double>::UnitX();
        const Vector3<double> y = Vector3<double>::UnitY();
        const Vector3<double> z = Vector3<double>::UnitZ();
        const Vector3<double> c = spine(t);
        tube([&](double u) { return Vector3<double>(c + (2 * u - 1) * half * y); },
             [&](double u) {
                 const double waist = 1.0 - 0.12 * (1.0 - std::pow(2 * u - 1, 2));
                 return Eigen::Vector2d(waist * size * 22, waist * size * 16);
             },
             x, z, c, 8, 14, 0.18);
        const Vector3<double> arch = c - size * mm_ * 22 * z;
        tube([&](double u) { return Vector3<double>(c + (0.3 + 0.7 * u) * (arch - c)); },
             [&](double) { return Eigen::Vector2d(12 * size, 5 * size); }, x, y, c, 6, 8, 0.25);
        const bool is_chest = i >= 5 && i < 17;
        const Vector3<double> tip = arch + size * mm_ * Vector3<double>(0, is_chest ? -24 : -8, -26);
        tube([&](double u) { return Vector3<double>(arch + u * (tip - arch)); },
             [&](double) { return Eigen::Vector2d(3.2, 6.5 * size); }, x, y, c, 8, 8, 0.2);
        for (const double sign : {1.0, -1.0}) {
            const Vector3<double> root = c + size * mm_ * Vector3<double>(sign * 10, 0, -17);
            const Vector3<double> end = c + size * mm_ * Vector3<double>(sign * 36, 2, is_chest ? -28 : -20);
            tube([&](double u) { return Vector3<double>(root + u * (end - root)); },
                 [&](double) { return Eigen::Vector2d(4.5 * size, 3.5 * size); }, y, z, c, 7, 8, 0.25);
        }
    }

    void sacrum() {
        start("sacrum");
        const Vector3<double> o = trunk_.origin(0.0);
        const Vector3<double> top = spine(0.01);
        const std::vector<Vector3<double>> path{
            top, top + mm_ * Vector3<double>(0, -22, -16), top + mm_ * Vector3<double>(0, -52, -26),
            top + mm_ * Vector3<double>(0, -82, -20), top + mm_ * Vector3<double>(0, -100, -6)};
        const std::vector<Eigen::Vector2d> widths{{44, 15}, {46, 13}, {32, 10}, {18, 7}, {7, 5}};
        tube([&](double u) { return along_stations<3>(path, u); },
             [&](double u) { return along_stations<2>(widths, u); }, Vector3<double>::UnitX(), Vector3<double>::UnitZ(),
             o, 18, 16, 0.1);
    }
};

}  // namespace softtissue
