// SPDX-License-Identifier: MIT
/// @file
/// What a report shows in 3D: meshes in views and layers, their positions and values in every frame.
#pragma once

#include <softtissue/core/notation.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace examples {

using softtissue::Index;
using softtissue::Matrix3X;

/// Something that surfaces can be coloured by, in `unit`; its scale goes from `low` to `high`.
struct ReportField {
    std::string name = {}, unit = {}, note = {};
    double low = 0.0, high = 1.0;
    bool is_signed = false;  // colours for both signs
    bool is_open = false;    // what lies beyond `high` is drawn as `high`
};

/// What is switched on and off together, in all views.
struct ReportLayer {
    std::string name = {};
    char key = 0;  // on the keyboard
    Eigen::Vector3f color = Eigen::Vector3f::Constant(0.8F);
    double opacity = 1.0;
    bool is_shown = true;
};

/// One of the pictures side by side.
struct ReportView {
    std::string name = {}, caption = {};
    bool is_shown = true;
};

/// A surface; or a skeleton, whose `bones` join two vertices each.
struct ReportMesh {
    Index view = 0, layer = 0;
    softtissue::Triangles triangles = {};
    softtissue::Connectivity<2> bones = {};
    Index similar_to = -1;  // an earlier mesh with as many vertices at nearly the same places: takes less room
};

struct ReportScene {
    struct Frame {
        double time = 0.0;
        std::string label = {};
        std::vector<Matrix3X<float>> positions = {};                      // by mesh [m]
        std::vector<std::vector<std::vector<std::uint8_t>>> values = {};  // by mesh, by field: codes
    };

    char up = 'y';
    bool is_motion = true;  // frames are moments of one motion [s]; otherwise poses, one after the other
    bool has_ground = true;
    std::vector<ReportField> fields = {};
    std::vector<ReportLayer> layers = {};
    std::vector<ReportView> views = {};
    std::vector<ReportMesh> meshes = {};
    std::vector<Frame> frames = {};
    Index poster = 0;  // the frame that is seen first
};

/// On the scale of the field; NaN has a code of its own.
std::vector<std::uint8_t> value_codes(const ReportField& field, const Eigen::VectorXf& values);

/// As the page reads it, null without meshes or frames; long arrays go to the end of `buffers`.
nlohmann::ordered_json scene_json(const ReportScene& scene, nlohmann::ordered_json& buffers);

}  // namespace examples
