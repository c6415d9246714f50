// SPDX-License-Identifier: MIT
/// @file
/// The bones of arm and leg.
///
/// What        LimbBones: femur, patella, tibia, fibula, humerus, radius, ulna of the left half.
/// Source      a design after anatomical plates: suggestive, not measured.
/// Tests       tests/unit/model/limb_bones_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>
#include <softtissue/model/bone_lofts.hpp>
#include <softtissue/model/human_solid.hpp>

#include <algorithm>
#include <vector>

namespace softtissue {

class LimbBones : private BoneLofts {
public:
    using BoneLofts::BoneLofts;

    std::vector<AnatomyMesh<double>> operator()() {
        leg();
        arm();
        return take();
    }

private:
    void leg() {
        using namespace human_joint;
        const BodyChart thigh = BodyChart::limb(body_, hip, knee, 1.0);
        start("femur");
        shaft(thigh,
              {Station(.00, 15, -5, 10, 11), Station(.05, 16, -4, 15, 16), Station(.11, 12, -2, 15, 16),
               Station(.22, 7, 3, 12, 13), Station(.36, 5, 5, 11, 11.5), Station(.52, 4, 6, 11, 11.5),
               Station(.68, 2, 5, 11.5, 12), Station(.82, 1, 2, 15, 13), Station(.91, 0, 0, 21, 15),
               Station(.96, 0, -1, 24, 17), Station(1.0, 0, -2, 22, 15)},
              26, 14);
        shaft(thigh,
              {Station(.075, 14, -2, 12, 12), Station(.045, 7, -1, 10, 11), Station(.02, 1, 0, 10, 10),
               Station(.0, -4, 0, 16, 17), Station(-.015, -8, 0, 20, 20), Station(-.045, -11, 0, 17, 18)},
              14, 14, 0.25);
        bulb(thigh, .975, 13, -6, {11, 20, 17});
        bulb(thigh, .975, -13, -6, {11, 20, 18});
        start("patella");
        const double room = body_.bone_distance(thigh.origin(.965), thigh.front()) / mm_;
        bulb(thigh, .965, 0, std::min(24.0, room - 9.0), {14, 6, 16});

        const BodyChart shank = BodyChart::limb(body_, knee, ankle, 1.0);
        start("tibia");
        shaft(shank,
              {Station(.015, -1, -1, 25, 18), Station(.045, -1, 0, 25, 19), Station(.10, -3, 3, 17, 18),
               Station(.20, -4, 5, 11.5, 14), Station(.36, -5, 5, 9.5, 12), Station(.55, -4, 4, 8.5, 10.5),
               Station(.75, -4, 3, 8.5, 9.5), Station(.90, -4, 1, 11, 11), Station(.97, -4, 0, 15, 14),
               Station(1.01, -5, 0, 14, 13)},
              26, 14, 0.04);
        bulb(shank, 1.0, -15, 1, {5, 8, 12});
        start("fibula");
        shaft(shank,
              {Station(.05, 17, -10, 5, 5.5), Station(.08, 17, -10, 7, 7), Station(.14, 15, -9, 4.5, 4.5),
               Station(.4, 13, -7, 4.2, 4.5), Station(.7, 12, -5, 4.2, 4.5), Station(.88, 13, -4, 4.5, 5),
               Station(.97, 15, -3, 6, 7.5), Station(1.03, 15, -3, 5, 6)},
              22, 10);
    }

    void arm() {
        using namespace human_joint;
        const BodyChart upper = BodyChart::limb(body_, shoulder, elbow, 1.0);
        start("humerus");
        shaft(upper,
              {Station(-.06, -4, 0, 15, 15), Station(-.01, -2, 0, 20, 20), Station(.05, 1, 0, 19, 19),
               Station(.12, 1, 0, 14, 14), Station(.24, 0, 0, 11, 11), Station(.42, 0, 0, 10, 10),
               Station(.6, 0, 0, 9.5, 9.5), Station(.78, 0, 0, 11, 9), Station(.9, 0, 0, 18, 9.5),
               Station(.96, 0, 0, 20, 10.5), Station(1.0, 0, 0, 17, 10)},
              26, 14, 0.09);
        bulb(upper, .97, 9, 2, {9, 11, 10});
        bulb(upper, .97, -8, 2, {9, 12, 11});

        const BodyChart forearm = BodyChart::limb(body_, elbow, wrist, 1.0);
        start("ulna");
        shaft(forearm,
              {Station(-.055, -4, -10, 8, 7), Station(-.01, -5, -9, 10, 9), Station(.05, -5, -6, 9, 9),
               Station(.14, -7, -4, 6.5, 7.5), Station(.35, -9, -2, 5.5, 6.5), Station(.65, -9, -1, 4.5, 5),
               Station(.9, -8, 0, 4.5, 4.5), Station(.97, -8, 0, 6.5, 6.5), Station(1.01, -8, 0, 5, 5)},
              22, 10, 0.08);
        start("radius");
        shaft(forearm,
              {Station(.02, 7, 3, 9, 9), Station(.05, 7, 3, 9, 9), Station(.09, 6, 3, 6, 6), Station(.16, 6, 4, 7, 7),
               Station(.35, 9, 3, 6, 5.5), Station(.6, 10, 2, 6, 5), Station(.82, 8, 1, 8, 6),
               Station(.95, 5, 0, 12, 8.5), Station(1.01, 4, 0, 12, 8)},
              22, 10, 0.04);
    }
};

}  // namespace softtissue
