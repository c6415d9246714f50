// SPDX-License-Identifier: MIT
/// @file
/// An animation of a glTF file: tracks of keys for places, turns and scales of nodes and for weights of morph targets.
///
/// What        GltfTrack::sample(): one property at a time; read_gltf_clips(): all animations of a file.
/// Equation    between keys 0 and 1, s = (t - t_0) / (t_1 - t_0):   step v_0,   linear (1 - s) v_0 + s v_1, turns along the
///             great circle,   cubic (2 s^3 - 3 s^2 + 1) v_0 + (s^3 - 2 s^2 + s) d b_0 + (3 s^2 - 2 s^3) v_1 + (s^3 - s^2) d a_1
///             with d = t_1 - t_0, outgoing tangent b_0, incoming a_1; turns are normalised. Outside its keys a track is constant.
/// Shapes      times: keys; values: rows x keys, for cubic interpolation rows x 3 keys (incoming tangent, value, outgoing tangent).
///             Turns are quaternions (w, x, y, z).
/// Units       s
/// Refuses     times that do not increase, a track of another number of keys than times, turns that are no unit quaternions, a
///             node that does not exist or is placed by a matrix (InvalidInput names file, channel and key).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.11, appendix C
/// Departs     channels without a node and channels of the extension KHR_animation_pointer are left out, as the specification says
/// Tests       tests/unit/io/gltf_clip_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_document.hpp>
#include <softtissue/io/json_element.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

enum class GltfProperty { translation, rotation, scale, weights };
enum class GltfInterpolation { step, linear, cubic };

/// One property of one node over time.
struct GltfTrack {
    std::int32_t node = 0;
    GltfProperty property = GltfProperty::translation;
    GltfInterpolation interpolation = GltfInterpolation::linear;
    VectorX<double> times;
    MatrixX<double> values;

    VectorX<double> sample(double time) const {
        const auto next = std::upper_bound(times.data(), times.data() + times.size(), time) - times.data();
        if (next == 0 || next == times.size()) {
            return key(next == 0 ? 0 : next - 1);
        }
        const Index last = next - 1;
        if (interpolation == GltfInterpolation::step) {
            return key(last);
        }
        const double d = times(next) - times(last);
        const double s = (time - times(last)) / d;
        const bool turns = property == GltfProperty::rotation;
        if (interpolation == GltfInterpolation::linear) {
            return turns ? slerp(key(last), key(next), s) : VectorX<double>((1.0 - s) * key(last) + s * key(next));
        }
        const double s2 = s * s, s3 = s2 * s;
        const VectorX<double> value = (2.0 * s3 - 3.0 * s2 + 1.0) * key(last) +
                                      (s3 - 2.0 * s2 + s) * d * values.col(3 * last + 2) +
                                      (3.0 * s2 - 2.0 * s3) * key(next) + (s3 - s2) * d * values.col(3 * next);
        return turns ? VectorX<double>(value.normalized()) : value;
    }

    VectorX<double> key(Index k) const { return values.col(interpolation == GltfInterpolation::cubic ? 3 * k + 1 : k); }

private:
    /// Along the shorter great circle.
    static VectorX<double> slerp(const VectorX<double>& from, const VectorX<double>& to, double s) {
        const VectorX<double> end = from.dot(to) < 0.0 ? VectorX<double>(-to) : to;
        const double angle = 2.0 * std::atan2((end - from).norm(), (end + from).norm());
        const double sine = std::sin(angle);
        if (sine < 1e-9) {  // the chord differs from the arc by less than rounding
            return ((1.0 - s) * from + s * end).normalized();
        }
        return (std::sin((1.0 - s) * angle) * from + std::sin(s * angle) * end) / sine;
    }
};

struct GltfClip {
    std::string name;
    std::vector<GltfTrack> tracks;
    double start = 0.0;  ///< first and last key of any track [s]
    double end = 0.0;

    double duration() const { return end - start; }

    /// Keys per second of the densest track; 0 if no track has two keys.
    double key_rate() const {
        double rate = 0.0;
        for (const GltfTrack& track : tracks) {
            const Index intervals = track.times.size() - 1;
            if (intervals > 0) {
                rate = std::max(rate, double(intervals) / (track.times(intervals) - track.times(0)));
            }
        }
        return rate;
    }
};

namespace detail {

inline Index num_morph_targets(const GltfDocument& document, Index node) {
    const JsonElement element = document.element("nodes", node);
    if (!element.has("mesh")) {
        return 0;
    }
    const JsonElement primitives =
        document.element("meshes", document.index(element.at("mesh"), "meshes")).at("primitives");
    return primitives.size() > 0 && primitives.at(0).has("targets") ? primitives.at(0).at("targets").size() : 0;
}

inline void read_times(GltfDocument& document, const JsonElement& sampler, GltfTrack& track) {
    const JsonElement input = sampler.at("input");
    track.times = document.read(input, "SCALAR").values.row(0).transpose();
    double last = -std::numeric_limits<double>::min();
    for (Index k = 0; k < track.times.size(); ++k) {
        require(track.times(k) > last, input.name(), ": time of key ", k, " = ", track.times(k),
                k == 0 ? ", expected >= 0" : ", expected more than that of the key before");
        last = track.times(k);
    }
}

/// Quaternions to (w, x, y, z); those that are no tangents to unit length.
inline void bring_turns_into_order(const JsonElement& output, GltfTrack& track) {
    MatrixX<double> ordered(4, track.values.cols());
    ordered << track.values.bottomRows(1), track.values.topRows(3);
    track.values = std::move(ordered);
    const bool is_cubic = track.interpolation == GltfInterpolation::cubic;
    for (Index k = 0; k < track.times.size(); ++k) {
        const Index column = is_cubic ? 3 * k + 1 : k;
        const double norm = track.values.col(column).norm();
        require(std::abs(norm - 1.0) <= 0.1, output.name(), ": the quaternion of key ", k, " has length ", norm,
                ", expected 1");
        track.values.col(column) /= norm;
    }
}

inline void read_values(GltfDocument& document, const JsonElement& sampler, GltfTrack& track) {
    const JsonElement output = sampler.at("output");
    const bool turns = track.property == GltfProperty::rotation;
    const bool is_cubic = track.interpolation == GltfInterpolation::cubic;
    const Index keys = (is_cubic ? 3 : 1) * track.times.size();
    if (track.property == GltfProperty::weights) {
        const Index targets = num_morph_targets(document, track.node);
        const MatrixX<double> values = document.read(output, "SCALAR").values;
        require(targets > 0 && values.cols() == targets * keys, output.name(), ": has ", values.cols(),
                " numbers, expected ", targets, " (morph targets) times ", keys);
        track.values = values.reshaped(targets, keys);
    } else {
        track.values = document.read(output, turns ? "VEC4" : "VEC3").values;
        require(track.values.cols() == keys, output.name(), ": has ", track.values.cols(), " elements, expected ",
                keys);
    }
    if (turns) {
        bring_turns_into_order(output, track);
    }
}

/// False for a channel that says nothing about a node.
inline bool read_track(GltfDocument& document, const JsonElement& animation, const JsonElement& channel,
                       GltfTrack& track) {
    const JsonElement target = channel.at("target");
    const std::string path = target.at("path").text();
    if (!target.has("node") || path == "pointer") {
        return false;
    }
    track.node = static_cast<std::int32_t>(document.index(target.at("node"), "nodes"));
    require(path == "translation" || path == "rotation" || path == "scale" || path == "weights", target.name(),
            ".path = ", path.substr(0, 40), ", expected translation, rotation, scale or weights");
    track.property = path == "translation" ? GltfProperty::translation
                     : path == "rotation"  ? GltfProperty::rotation
                     : path == "scale"     ? GltfProperty::scale
                                           : GltfProperty::weights;
    require(track.property == GltfProperty::weights || !document.element("nodes", track.node).has("matrix"),
            target.name(), ".node = ", track.node, " is placed by a matrix, expected translation, rotation and scale");
    const JsonElement samplers = animation.at("samplers");
    const JsonElement sampler = samplers.at(channel.at("sampler").integer(0, samplers.size() - 1));
    const std::string kind = sampler.has("interpolation") ? sampler.at("interpolation").text() : "LINEAR";
    require(kind == "STEP" || kind == "LINEAR" || kind == "CUBICSPLINE", sampler.name(),
            ".interpolation = ", kind.substr(0, 40), ", expected STEP, LINEAR or CUBICSPLINE");
    track.interpolation = kind == "STEP"     ? GltfInterpolation::step
                          : kind == "LINEAR" ? GltfInterpolation::linear
                                             : GltfInterpolation::cubic;
    read_times(document, sampler, track);
    read_values(document, sampler, track);
    return true;
}

}  // namespace detail

/// All animations of the file. One without a name is called by its number.
inline std::vector<GltfClip> read_gltf_clips(GltfDocument& document) {
    std::vector<GltfClip> clips;
    for (const JsonElement& animation : document.root().items("animations")) {
        GltfClip& clip = clips.emplace_back();
        clip.name = animation.has("name") ? animation.at("name").text() : std::to_string(clips.size() - 1);
        double first = std::numeric_limits<double>::infinity();
        for (const JsonElement& channel : animation.items("channels")) {
            GltfTrack track;
            if (detail::read_track(document, animation, channel, track)) {
                first = std::min(first, track.times(0));
                clip.end = std::max(clip.end, track.times(track.times.size() - 1));
                clip.tracks.push_back(std::move(track));
            }
        }
        clip.start = std::min(first, clip.end);
    }
    return clips;
}

}  // namespace softtissue
