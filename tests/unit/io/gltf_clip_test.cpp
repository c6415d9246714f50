// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_clip.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

GltfTrack track(GltfProperty property, GltfInterpolation interpolation, const VectorX<double>& times,
                const MatrixX<double>& values) {
    GltfTrack result;
    result.property = property;
    result.interpolation = interpolation;
    result.times = times;
    result.values = values;
    return result;
}

const VectorX<double> two_times = (VectorX<double>(2) << 1, 3).finished();

std::string refused(const TemporaryFolder& folder, const GltfFile& file) {
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    return refusal([&] { read_gltf_clips(document); });
}

}  // namespace

TEST_CASE("steps, lines and cubics between the keys, constant outside") {
    const MatrixX<double> values = (MatrixX<double>(3, 2) << 0, 4, 1, 1, 2, -2).finished();
    const GltfTrack steps = track(GltfProperty::translation, GltfInterpolation::step, two_times, values);
    const GltfTrack lines = track(GltfProperty::translation, GltfInterpolation::linear, two_times, values);
    CHECK(steps.sample(2.999) == values.col(0));
    CHECK(steps.sample(3.0) == values.col(1));
    CHECK(lines.sample(2.5) == (VectorX<double>(3) << 3, 1, -1).finished());
    for (const GltfTrack* either : {&steps, &lines}) {
        CHECK(either->sample(-7.0) == values.col(0));
        CHECK(either->sample(1.0) == values.col(0));
        CHECK(either->sample(9.0) == values.col(1));
    }

    // A cubic polynomial comes back exactly from its values and slopes.
    const auto p = [](double t) { return 2.0 * t * t * t - t * t + 5.0 * t - 3.0; };
    const auto slope = [](double t) { return 6.0 * t * t - 2.0 * t + 5.0; };
    MatrixX<double> keys(1, 6);
    keys << 99.0, p(1), slope(1), slope(3), p(3), 99.0;
    const GltfTrack cubic = track(GltfProperty::weights, GltfInterpolation::cubic, two_times, keys);
    for (const double t : {1.0, 1.3, 2.0, 2.9, 3.0}) {
        CHECK(cubic.sample(t)(0) == doctest::Approx(p(t)).epsilon(1e-14));
    }
    CHECK(cubic.sample(0.0)(0) == p(1));
}

TEST_CASE("turns go the shorter way at constant speed") {
    const auto about_z = [](double angle) {
        return (VectorX<double>(4) << std::cos(angle / 2), 0, 0, std::sin(angle / 2)).finished();
    };
    MatrixX<double> values(4, 2);
    values << about_z(0.2), -about_z(1.4);
    const GltfTrack turn = track(GltfProperty::rotation, GltfInterpolation::linear, two_times, values);
    CHECK((turn.sample(1.5) - about_z(0.5)).norm() < 1e-15);
    CHECK((turn.sample(2.5) - about_z(1.1)).norm() < 1e-15);
    values << about_z(0.2), about_z(0.2 + 1e-12);
    const GltfTrack still = track(GltfProperty::rotation, GltfInterpolation::linear, two_times, values);
    CHECK((still.sample(2.0) - about_z(0.2)).norm() < 1e-11);
    MatrixX<double> keys = MatrixX<double>::Zero(4, 6);
    keys.col(1) = about_z(0.2);
    keys.col(4) = about_z(1.4);
    const GltfTrack cubic = track(GltfProperty::rotation, GltfInterpolation::cubic, two_times, keys);
    CHECK((cubic.sample(2.0) - about_z(0.8)).norm() < 1e-15);
    CHECK(std::abs(cubic.sample(1.3).norm() - 1.0) < 1e-15);
}

TEST_CASE("clips come from the file") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    const int times = file.add(std::vector<float>{0.5F, 1.5F, 2.0F}, "SCALAR");
    const int weights = file.add(std::vector<float>{0, 1, 0}, "SCALAR");
    nlohmann::json second = {{"channels",
                              {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "weights"}}}},
                               {{"sampler", 0}, {"target", {{"path", "weights"}}}},
                               {{"sampler", 0}, {"target", {{"node", 3}, {"path", "pointer"}}}}}},
                             {"samplers", {{{"input", times}, {"output", weights}, {"interpolation", "STEP"}}}}};
    file.json["animations"].push_back(second);
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    const std::vector<GltfClip> clips = read_gltf_clips(document);
    REQUIRE(clips.size() == 2);
    CHECK(clips[0].name == "wave");
    CHECK(clips[0].start == 0.0);
    CHECK(clips[0].duration() == 1.0);
    CHECK(clips[0].key_rate() == 1.0);
    REQUIRE(clips[0].tracks.size() == 2);
    CHECK(clips[0].tracks[0].node == 1);
    CHECK(clips[0].tracks[0].sample(0.0) == (VectorX<double>(4) << 1, 0, 0, 0).finished());
    CHECK(clips[0].tracks[0].sample(0.5)(3) == doctest::Approx(std::sin(std::acos(-1.0) / 8)));
    CHECK(clips[0].tracks[1].sample(0.5) == (VectorX<double>(3) << 0, 1, 0).finished());
    CHECK(clips[1].name == "1");
    CHECK(clips[1].start == 0.5);
    CHECK(clips[1].end == 2.0);
    REQUIRE(clips[1].tracks.size() == 1);
    CHECK(clips[1].tracks[0].interpolation == GltfInterpolation::step);
    CHECK(clips[1].tracks[0].sample(1.7)(0) == 1.0);
}

TEST_CASE("bytes make turns and cubic keys come in threes") {
    const TemporaryFolder folder;
    GltfFile file = rigged_bar();
    const int turns = file.add(std::vector<std::uint8_t>{0, 0, 0, 127, 0, 0, 90, 90}, "VEC4", true);
    file.json["accessors"][std::size_t(turns)]["componentType"] = 5120;
    file.json["animations"][0]["samplers"][0]["output"] = turns;
    const int cubic = file.add(std::vector<float>(18, 2.0F), "VEC3");
    file.json["animations"][0]["samplers"][1]["output"] = cubic;
    file.json["animations"][0]["samplers"][1]["interpolation"] = "CUBICSPLINE";
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    const std::vector<GltfClip> clips = read_gltf_clips(document);
    CHECK((clips[0].tracks[0].sample(1.0) - (VectorX<double>(4) << 1, 0, 0, 1).finished().normalized()).norm() < 1e-15);
    CHECK(clips[0].tracks[1].values.cols() == 6);
}

TEST_CASE("channels that make no sense are refused") {
    const TemporaryFolder folder;
    const auto with = [&](const char* pointer, const nlohmann::json& value) {
        GltfFile file = rigged_bar();
        file.json["animations"][0][nlohmann::json::json_pointer(pointer)] = value;
        return refused(folder, file);
    };
    CHECK(
        contains(with("/channels/0/target/node", 9), "animations[0].channels[0].target.node = 9, expected an integer"));
    CHECK(contains(with("/channels/0/target/path", "color"), "target.path = color, expected translation"));
    CHECK(contains(with("/channels/0/sampler", 2), "channels[0].sampler = 2, expected an integer from 0 to 1"));
    CHECK(contains(with("/channels/0/target/path", "weights"), "type = VEC4, expected SCALAR"));
    CHECK(contains(with("/samplers/0/interpolation", "BEZIER"), "samplers[0].interpolation = BEZIER"));
    CHECK(contains(with("/samplers/0/interpolation", "CUBICSPLINE"), "samplers[0].output: has 2 elements, expected 6"));
    GltfFile backwards = rigged_bar();
    backwards.json["animations"][0]["samplers"][0]["input"] = backwards.add(std::vector<float>{1, 1}, "SCALAR");
    CHECK(contains(refused(folder, backwards), "samplers[0].input: time of key 1 = 1, expected more"));
    GltfFile early = rigged_bar();
    early.json["animations"][0]["samplers"][0]["input"] = early.add(std::vector<float>{-1, 1}, "SCALAR");
    CHECK(contains(refused(folder, early), "time of key 0 = -1, expected >= 0"));
    GltfFile long_turn = rigged_bar();
    long_turn.json["animations"][0]["samplers"][0]["output"] =
        long_turn.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 3}, "VEC4");
    CHECK(contains(refused(folder, long_turn), "the quaternion of key 1 has length 3, expected 1"));
    GltfFile fixed = rigged_bar();
    fixed.json["nodes"][1].erase("translation");
    fixed.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1};
    CHECK(contains(refused(folder, fixed), "node = 1 is placed by a matrix"));
    GltfFile no_targets = rigged_bar();
    no_targets.json["animations"][0]["channels"][0]["target"] = {{"node", 0}, {"path", "weights"}};
    no_targets.json["animations"][0]["samplers"][0]["output"] = no_targets.add(std::vector<float>{0, 1}, "SCALAR");
    CHECK(contains(refused(folder, no_targets), "expected 0 (morph targets) times 2"));
}
