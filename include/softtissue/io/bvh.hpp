// SPDX-License-Identifier: MIT
/// @file
/// Motion capture in Biovision's format (.bvh): a skeleton with its motion.
///
/// What        names, tree and rest positions of the joints (all channels zero), end sites, local rotations as rotation
///             vectors, translation of the root. Channels in any order and number, joints without channels.
/// Equation    R = R_1(a_1) R_2(a_2) R_3(a_3) for rotation channels 1, 2, 3 in the order of the file, a in degrees
/// Units       lengths of the file times `scale`, to make metres; frame rate = 1 / frame time.
/// Positions   of the root: take the place of its offset. Of another joint: either the offset again or a displacement from
///             it; bones are rigid here, so that either way the joint may move by at most 1 % of the longest offset, which
///             is left out.
/// Refuses     anything but this grammar, numbers that cannot be read or are not finite, joint names that appear twice, a
///             frame count that is not that of the numbers, fewer channels than joints, joints that leave their place,
///             a frame time that is not positive (InvalidInput names file and line).
/// Source      Meredith & Maddock 2001, "Motion Capture File Formats Explained", sec. 2.1
/// Tests       tests/unit/io/bvh_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/skeleton.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

/// Where a bone ends that no further joint follows.
template <RealScalar S>
struct BvhEndSite {
    std::int32_t joint = 0;
    Vector3<S> position;  ///< at rest [m]
};

template <RealScalar S>
struct BvhClip {
    Skeleton<S> skeleton;
    std::vector<BvhEndSite<S>> end_sites;
    Motion<S> motion;
};

namespace detail {

template <RealScalar S>
class BvhParser {
public:
    BvhParser(std::string file, std::string_view text, double scale)
        : file_(std::move(file)), text_(text), scale_(scale) {}

    BvhClip<S> parse() {
        parse_hierarchy();
        parse_motion();
        return std::move(clip_);
    }

private:
    struct Channel {
        bool is_rotation = false;
        int axis = 0;
    };
    struct Joint {
        Vector3<double> offset = Vector3<double>::Zero();
        std::vector<Channel> channels;
        bool has_offset = false;
        double farthest_from_offset = 0.0;  ///< of its position channels
        double farthest_from_zero = 0.0;
    };

    template <class... Parts>
    [[noreturn]] void refuse(const Parts&... parts) const {
        throw_invalid_input(file_, ": line ", line_, ": ", parts...);
    }

    /// The next word or brace; empty at the end.
    std::string_view next() {
        const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        while (place_ < text_.size() && is_space(text_[place_])) {
            line_ += text_[place_++] == '\n' ? 1 : 0;
        }
        const std::size_t first = std::min(place_, text_.size());
        const auto is_brace = [](char c) { return c == '{' || c == '}'; };
        do {
            ++place_;
        } while (place_ < text_.size() && !is_space(text_[place_]) && !is_brace(text_[place_]) &&
                 !is_brace(text_[place_ - 1]));
        return text_.substr(first, place_ - first);
    }

    void expect(std::string_view expected) {
        const std::string_view word = next();
        if (word != expected) {
            refuse("found '", word, "', expected ", expected);
        }
    }

    template <class T>
    T next_number(const char* expected) {
        std::string_view word = next();
        word.remove_prefix(word.starts_with('+') ? 1 : 0);
        T value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool is_read = error == std::errc() && end == word.data() + word.size();
        if (!is_read || !(std::is_integral_v<T> ? value >= T(0) : std::isfinite(double(value)))) {
            refuse("found '", word, "', expected ", expected);
        }
        return value;
    }
    double next_real() { return next_number<double>("a finite number"); }
    Index next_count() { return next_number<Index>("a whole number >= 0"); }

    Vector3<double> next_lengths() {
        Vector3<double> lengths;
        for (double& length : lengths) {
            length = scale_ * next_real();
        }
        return lengths;
    }

    void parse_hierarchy() {
        expect("HIERARCHY");
        expect("ROOT");
        std::vector<std::int32_t> open{open_joint(KinematicTree::no_parent)};
        while (!open.empty()) {
            Joint& joint = joints_[std::size_t(open.back())];
            const std::string_view word = next();
            if (word == "JOINT") {
                open.push_back(open_joint(open.back()));
            } else if (word == "End") {
                expect("Site");
                expect("{");
                expect("OFFSET");
                clip_.end_sites.push_back({open.back(), next_lengths().template cast<S>()});
                expect("}");
            } else if (word == "OFFSET" && !joint.has_offset) {
                joint.offset = next_lengths();
                joint.has_offset = true;
            } else if (word == "CHANNELS" && joint.channels.empty()) {
                parse_channels(joint);
            } else if (word == "}" && joint.has_offset) {
                open.pop_back();
            } else {
                refuse("found '", word, "' in joint '", clip_.skeleton.joint_names[std::size_t(open.back())],
                       "', expected one OFFSET, one CHANNELS, then JOINT, End Site or }");
            }
        }
        // So that the poses in memory are not much larger than their text.
        require(num_channels_ >= Index(joints_.size()), file_, ": ", num_channels_, " channels for ", joints_.size(),
                " joints, expected at least as many");
        place_joints();
    }

    std::int32_t open_joint(std::int32_t parent) {
        std::string name(next());
        const Index line = line_;
        for (std::string_view word = next(); word != "{"; word = next()) {
            if (word.empty() || word == "}" || line_ != line) {
                refuse("found '", word, "' after joint '", name, "', expected {");
            }
            name += " " + std::string(word);
        }
        joints_.emplace_back();
        parents_.push_back(parent);
        clip_.skeleton.joint_names.push_back(std::move(name));
        return static_cast<std::int32_t>(joints_.size()) - 1;
    }

    void parse_channels(Joint& joint) {
        const Index count = next_count();
        for (Index c = 0; c < count; ++c) {
            const std::string_view word = next();
            const bool is_rotation = word.ends_with("rotation");
            const bool is_known =
                (is_rotation || word.ends_with("position")) && word.size() == 9 && word[0] >= 'X' && word[0] <= 'Z';
            if (!is_known) {
                refuse("found '", word, "', expected a channel such as Xposition or Zrotation");
            }
            joint.channels.push_back({is_rotation, word[0] - 'X'});
        }
        num_channels_ += count;
    }

    void place_joints() {
        Skeleton<S>& skeleton = clip_.skeleton;
        skeleton.tree = KinematicTree(parents_);
        skeleton.joints.resize(3, Index(joints_.size()));
        for (std::size_t j = 0; j < joints_.size(); ++j) {  // parents come first
            const std::int32_t parent = parents_[j];
            skeleton.joints.col(Index(j)) = joints_[j].offset.template cast<S>();
            if (parent != KinematicTree::no_parent) {
                skeleton.joints.col(Index(j)) += skeleton.joints.col(parent);
            }
        }
        for (BvhEndSite<S>& site : clip_.end_sites) {
            site.position += skeleton.joints.col(site.joint);
            require(site.position.allFinite(), file_, ": an end site of joint ", site.joint, " is not finite");
        }
        skeleton.validate(file_);
    }

    void parse_motion() {
        expect("MOTION");
        expect("Frames:");
        const Index frames = next_count();
        expect("Frame");
        expect("Time:");
        const double frame_time = next_real();
        if (!(frame_time > 0.0) || frames == 0) {
            refuse(frames, " frames of ", frame_time, " s, expected at least one frame and a time > 0");
        }
        clip_.motion.frame_rate = S(1.0 / frame_time);
        for (Index t = 0; t < frames; ++t) {
            clip_.motion.poses.push_back(next_pose());
        }
        if (!next().empty()) {
            refuse("numbers after the last of ", frames, " frames, expected the end of the file");
        }
        require_rigid_bones();
        clip_.motion.validate(file_, Index(joints_.size()));  // in S, too
    }

    Pose<S> next_pose() {
        Pose<S> pose = Pose<S>::rest(Index(joints_.size()));
        for (std::size_t j = 0; j < joints_.size(); ++j) {
            Joint& joint = joints_[j];
            Quaternion<double> rotation(1, 0, 0, 0);
            Vector3<double> position = joint.offset;
            bool moves = false;
            for (const Channel& channel : joint.channels) {
                const double value = next_real();
                if (channel.is_rotation) {
                    const Vector3<double> turn = value * std::numbers::pi / 180.0 * Vector3<double>::Unit(channel.axis);
                    rotation = quaternion_product<double>(rotation, quaternion_from_rotation_vector<double>(turn));
                } else {
                    position(channel.axis) = scale_ * value;
                    moves = true;
                }
            }
            pose.rotation_vectors.col(Index(j)) = rotation_vector_from_quaternion<double>(rotation).template cast<S>();
            if (j == 0) {
                pose.translation = (position - joint.offset).template cast<S>();
            } else if (moves) {
                joint.farthest_from_offset = std::max(joint.farthest_from_offset, (position - joint.offset).norm());
                joint.farthest_from_zero = std::max(joint.farthest_from_zero, position.norm());
            }
        }
        return pose;
    }

    void require_rigid_bones() const {
        double longest = 0.0;
        for (const Joint& joint : joints_) {
            longest = std::max(longest, joint.offset.norm());
        }
        for (std::size_t j = 1; j < joints_.size(); ++j) {
            const double moved = std::min(joints_[j].farthest_from_offset, joints_[j].farthest_from_zero);
            require(moved <= 0.01 * longest, file_, ": joint '", clip_.skeleton.joint_names[j], "' moves by ", moved,
                    " m against its parent, expected rigid bones");
        }
    }

    std::string file_;
    std::string_view text_;
    double scale_;
    std::size_t place_ = 0;
    Index line_ = 1;
    Index num_channels_ = 0;
    std::vector<Joint> joints_;
    std::vector<std::int32_t> parents_;
    BvhClip<S> clip_;
};

}  // namespace detail

/// The clip in `path`; its lengths times `scale` are metres.
template <RealScalar S>
BvhClip<S> read_bvh(const std::filesystem::path& path, double scale = 1.0) {
    require(std::isfinite(scale) && scale > 0.0, "bvh: scale is ", scale, ", expected > 0");
    require(std::filesystem::is_regular_file(path), path.string(), ": is no file, expected a .bvh file");
    std::ifstream stream(path, std::ios::binary);
    require(stream.is_open(), path.string(), ": cannot be opened");
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    return detail::BvhParser<S>(path.string(), text, scale).parse();
}

}  // namespace softtissue
