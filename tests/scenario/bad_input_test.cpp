// SPDX-License-Identifier: MIT
// Bad input through the public doors: one clear error that names file, array or vertex and what was expected.
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/io/obj.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/io/vtu.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/catch.hpp>
#include <support/capsule_body.hpp>
#include <unit/io/io_test_support.hpp>

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class T>
NpyArray array(const std::vector<T>& values, std::vector<Index> shape) {
    return NpyArray::from_values(std::span<const T>(values), std::move(shape));
}

/// An octahedron on a chain of three joints.
NpyArrays good_body() {
    NpyArrays arrays;
    arrays["v_template"] =
        array<double>({1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1}, {6, 3});
    arrays["f"] = array<std::int32_t>({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, {8, 3});
    arrays["kintree_table"] = array<std::int64_t>({-1, 0, 1, 0, 1, 2}, {2, 3});
    arrays["weights"] = array<double>({1, 0, 0, 0.5, 0.5, 0, 0.25, 0.25, 0.5, 0, 1, 0, 0, 0, 1, 0, 0.75, 0.25}, {6, 3});
    arrays["J_regressor"] = array<double>({0, 1, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5, 1, 0, 0, 0, 0, 0}, {3, 6});
    arrays["shapedirs"] = array(std::vector<float>(36, 0.5F), {6, 3, 2});
    arrays["posedirs"] = array(std::vector<float>(6 * 3 * 18, 0.0F), {6, 3, 18});
    return arrays;
}

NpyArrays good_motion() {
    NpyArrays arrays;
    arrays["poses"] = array(std::vector<double>(4 * 9, 0.1), {4, 9});
    arrays["trans"] = array(std::vector<double>(4 * 3, 0.0), {4, 3});
    arrays["mocap_framerate"] = NpyArray::from_scalar(60.0);
    return arrays;
}

/// `name` with the value at `place` replaced.
template <class T>
void spoil(NpyArrays& arrays, const char* name, size_t place, T value) {
    std::vector<T> values = arrays.at(name).as<T>();
    values.at(place) = value;
    arrays[name] = array(values, arrays.at(name).shape());
}

void read_body(const TemporaryFolder& folder, const NpyArrays& arrays) {
    write_npz(folder / "body.npz", arrays);
    static_cast<void>(read_smpl_body<double>(folder / "body.npz"));
}
void read_motion(const TemporaryFolder& folder, const NpyArrays& arrays) {
    write_npz(folder / "walk.npz", arrays);
    static_cast<void>(read_amass_motion<double>(folder / "walk.npz", 3));
}

struct Case {
    const char* what;
    std::function<void(NpyArrays&)> spoil;
    std::vector<std::string> expected;  ///< parts of the message beside the file's name
};

void check(const std::string& text, const std::vector<std::string>& expected) {
    INFO("message: " << text);
    CHECK_FALSE(text.empty());
    CHECK(text.find('\n') == std::string::npos);
    for (const std::string& part : expected) {
        INFO("expected: " << part);
        CHECK(contains(text, part));
    }
}

const std::vector<Case> bad_bodies{
    {"missing array", [](NpyArrays& a) { a.erase("weights"); }, {"weights"}},
    {"missing surface", [](NpyArrays& a) { a.erase("f"); }, {"f"}},
    {"wrong shape", [](NpyArrays& a) { a["v_template"] = array(std::vector<double>(12, 1.0), {6, 2}); },
     {"v_template", "3", "2"}},
    {"weights of other joints", [](NpyArrays& a) { a["weights"] = array(std::vector<double>(12, 0.5), {6, 2}); },
     {"weights", "(6, 3)", "(6, 2)"}},
    {"pose blend shapes of other joints",
     [](NpyArrays& a) { a["posedirs"] = array(std::vector<float>(6 * 3 * 9), {6, 3, 9}); }, {"posedirs", "(6, 3, 18)"}},
    {"NaN vertex", [](NpyArrays& a) { spoil(a, "v_template", 7, nan_value); }, {"v_template", "vertex 2", "not finite"}},
    {"infinite shape", [](NpyArrays& a) { spoil(a, "shapedirs", 13, float(infinity)); },
     {"shapedirs", "vertex 2", "not finite"}},
    {"NaN weight", [](NpyArrays& a) { spoil(a, "weights", 4, nan_value); }, {"weights[1, 1]", "expected a finite value"}},
    {"negative weight", [](NpyArrays& a) { spoil(a, "weights", 4, -0.5); }, {"weights[1, 1] = -0.5", ">= 0"}},
    {"weights that do not sum to one", [](NpyArrays& a) { spoil(a, "weights", 4, 0.6); },
     {"weights of vertex 1 sum to 1.1", "expected 1"}},
    {"NaN regressor", [](NpyArrays& a) { spoil(a, "J_regressor", 8, nan_value); }, {"J_regressor[1, 2]", "finite"}},
    {"open surface",
     [](NpyArrays& a) { a["f"] = array<std::int32_t>({0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5}, {7, 3}); },
     {"edge (", "expected a closed surface"}},
    {"non-manifold surface",
     [](NpyArrays& a) {
         a["f"] = array<std::int32_t>(
             {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5, 0, 2, 1}, {9, 3});
     },
     {"edge (0, 2)", "triangles 0, 4 and 8", "at most two"}},
    {"triangles inside out",
     [](NpyArrays& a) {
         a["f"] = array<std::int32_t>({2, 0, 4, 1, 2, 4, 3, 1, 4, 0, 3, 4, 0, 2, 5, 2, 1, 5, 1, 3, 5, 3, 0, 5}, {8, 3});
     },
     {"face inwards"}},
    {"degenerate triangle by index", [](NpyArrays& a) { spoil<std::int32_t>(a, "f", 3, 1); },
     {"triangle 1 uses vertex 1 twice"}},
    {"degenerate triangle by position",
     [](NpyArrays& a) {
         spoil(a, "v_template", 12, 1.0);
         spoil(a, "v_template", 14, 0.0);
     },
     {"triangle ", "area", "expected > 0"}},
    {"vertex out of range", [](NpyArrays& a) { spoil<std::int32_t>(a, "f", 3, 6); }, {"6", "0 to 5"}},
    {"cyclic tree", [](NpyArrays& a) { a["kintree_table"] = array<std::int64_t>({-1, 2, 1, 0, 1, 2}, {2, 3}); },
     {"kinematic tree", "joint 1"}},
    {"tree without root", [](NpyArrays& a) { a["kintree_table"] = array<std::int64_t>({2, 0, 1, 0, 1, 2}, {2, 3}); },
     {"kinematic tree", "expected one root (a cycle)"}},
    {"unknown parent", [](NpyArrays& a) { a["kintree_table"] = array<std::int64_t>({-1, 7, 1, 0, 1, 2}, {2, 3}); },
     {"kintree_table", "parent of joint 1 is 7"}},
};

const std::vector<Case> bad_motions{
    {"another skeleton", [](NpyArrays& a) { a["poses"] = array(std::vector<double>(4 * 12), {4, 12}); },
     {"poses", "12 columns, expected 9 for 3 joints", "another skeleton"}},
    {"missing translation", [](NpyArrays& a) { a.erase("trans"); }, {"trans"}},
    {"missing frame rate", [](NpyArrays& a) { a.erase("mocap_framerate"); }, {"mocap_framerate"}},
    {"translation of another length", [](NpyArrays& a) { a["trans"] = array(std::vector<double>(9), {3, 3}); },
     {"trans", "(4, 3)", "(3, 3)"}},
    {"NaN rotation", [](NpyArrays& a) { spoil(a, "poses", 9 + 4, nan_value); }, {"frame 1, joint 1", "not finite"}},
    {"infinite translation", [](NpyArrays& a) { spoil(a, "trans", 7, infinity); }, {"frame 2", "translation is not finite"}},
    {"no frame rate", [](NpyArrays& a) { a["mocap_framerate"] = NpyArray::from_scalar(0.0); }, {"frame rate is 0", "> 0"}},
    {"no frames",
     [](NpyArrays& a) {
         a["poses"] = array(std::vector<double>{}, {0, 9});
         a["trans"] = array(std::vector<double>{}, {0, 3});
     },
     {"no frames"}},
};

}  // namespace

TEST_CASE("bad bodies and motions are refused with the file's name", "[bad input]") {
    const TemporaryFolder folder;
    REQUIRE_NOTHROW(read_body(folder, good_body()));
    REQUIRE_NOTHROW(read_motion(folder, good_motion()));
    for (const Case& bad : bad_bodies) {
        INFO(bad.what);
        NpyArrays arrays = good_body();
        bad.spoil(arrays);
        const std::string text = refusal([&] { read_body(folder, arrays); });
        check(text, bad.expected);
        check(text, {"body.npz"});
    }
    for (const Case& bad : bad_motions) {
        INFO(bad.what);
        NpyArrays arrays = good_motion();
        bad.spoil(arrays);
        const std::string text = refusal([&] { read_motion(folder, arrays); });
        check(text, bad.expected);
        check(text, {"walk.npz"});
    }
}

TEST_CASE("damaged files are refused wherever the damage is", "[bad input]") {
    const TemporaryFolder folder;
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_npz(folder / "body.npz", good_body(), compression);
        const std::string bytes = read_bytes(folder / "body.npz");
        const auto read = [&] { static_cast<void>(read_smpl_body<double>(folder / "damaged.npz")); };
        for (const size_t length : {size_t(0), size_t(3), size_t(100), bytes.size() / 2, bytes.size() - 1}) {
            INFO("cut after " << length << " of " << bytes.size() << " bytes");
            write_bytes(folder / "damaged.npz", bytes.substr(0, length));
            check(refusal(read), {"damaged.npz"});
        }
        // a bit turned in the numbers of an array
        const size_t data = bytes.find("v_template.npy") + 14 + (compression == NpzCompression::stored ? 128 + 40 : 20);
        std::string damaged = bytes;
        damaged[data] = char(damaged[data] ^ 4);
        write_bytes(folder / "damaged.npz", damaged);
        check(refusal(read), {"damaged.npz", "v_template"});
    }
    check(refusal([&] { static_cast<void>(read_smpl_body<double>(folder / "absent.npz")); }), {"absent.npz"});
    write_bytes(folder / "text.npz", "this is no archive");
    check(refusal([&] { static_cast<void>(read_smpl_body<double>(folder / "text.npz")); }), {"text.npz"});
}

TEST_CASE("a thickness out of bounds or that would invert cells is refused on request", "[bad input]") {
    CapsuleBody<double> body;
    body.positions(0, body.vertex(body.num_rings / 2, 0)) = 0.045;  // a dent: little room around it
    SoftLayerOptions<double> options;
    options.region.extremities = JointGroups{{0}, {2}};
    SoftLayer<double> layer = make_soft_layer(body.positions, body.faces, body.weights, body.tree, body.joints, options);
    const auto refused = [&](const VectorX<double>& thickness) {
        return refusal([&] { static_cast<void>(with_thickness(layer, thickness, ThicknessPolicy::refuse)); });
    };
    VectorX<double> thickness = layer.thickness;
    thickness.setConstant(0.01);
    thickness(3) = 0.7;
    check(refused(thickness), {"thickness of body vertex " + std::to_string(layer.region.body_vertices[3]) + " = 0.7", "expected 0.003 to"});
    thickness(3) = nan_value;
    check(refused(thickness), {"thickness of body vertex " + std::to_string(layer.region.body_vertices[3]), "not finite"});
    layer.skeleton_distance.setConstant(1.0);
    thickness.setConstant(0.06);
    check(refused(thickness), {"thickness makes the cells below body triangle ", "expected"});
}

TEST_CASE("material constants that make no material are refused", "[bad input]") {
    using Law = StableNeoHookean<double>;
    check(refusal([] { static_cast<void>(Law::from_young_poisson({-1e4, 0.3})); }), {"young_modulus = -10000", "positive"});
    check(refusal([] { static_cast<void>(Law::from_young_poisson({0.0, 0.3})); }), {"young_modulus = 0", "positive"});
    check(refusal([] { static_cast<void>(Law::from_young_poisson({1e4, 0.5})); }), {"poisson_ratio = 0.5", "< 0.5"});
    check(refusal([] { static_cast<void>(Law::from_young_poisson({1e4, nan_value})); }), {"poisson_ratio = nan", "< 0.5"});
    check(refusal([] { static_cast<void>(Law({.mu = 1e4, .lambda = -1.0})); }), {"lambda = -1", "positive"});
    check(refusal([] { static_cast<void>(Arap<double>({.stiffness = infinity})); }), {"stiffness = inf", "finite"});
    check(refusal([] { static_cast<void>(CorotatedLinearPolar<double>::from_young_poisson({1e4, 0.7})); }),
          {"poisson_ratio = 0.7", "< 0.5"});
    const Matrix3<double> axes = Matrix3<double>::Identity();
    check(refusal([&] { static_cast<void>(FungOrthotropic<double>({.normal_modulus = -1, .tangential_modulus = 1e4}, axes)); }),
          {"normal_modulus = -1", "positive"});
    check(refusal([&] {
              static_cast<void>(
                  FungOrthotropic<double>({.normal_modulus = 1e4, .tangential_modulus = 1e4, .poisson_ratio = 0.5}, axes));
          }),
          {"poisson_ratio = 0.5", "< 0.5"});
}

TEST_CASE("a writer that fails leaves nothing behind", "[bad input]") {
    const TemporaryFolder folder;
    write_npz(folder / "body.npz", good_body());
    SmplBody<double> body = read_smpl_body<double>(folder / "body.npz");
    const std::string before = read_bytes(folder / "body.npz");

    SmplBody<double> spoilt = body;
    spoilt.template_vertices(1, 2) = nan_value;
    check(refusal([&] { write_smpl_body(folder / "body.npz", spoilt); }), {"body.npz", "vertex 2"});
    CHECK(read_bytes(folder / "body.npz") == before);
    check(refusal([&] { write_smpl_body(folder / "new.npz", spoilt); }), {"new.npz"});

    AmassClip<double> clip;
    clip.motion.frame_rate = 60;
    clip.motion.poses.assign(3, Pose<double>::rest(3));
    clip.motion.poses[1].translation(0) = infinity;
    check(refusal([&] { write_amass_clip(folder / "walk.npz", clip); }), {"walk.npz", "frame 1"});

    const Matrix3X<double> positions = body.template_vertices;
    VtuFields too_few;
    too_few.vertex_arrays.push_back({"u", MatrixX<float>::Zero(3, 2)});
    check(refusal([&] { write_vtu(folder / "frame.vtu", positions, body.faces, too_few); }), {"frame.vtu", "u"});
    CHECK(folder.num_files() == 1);

    for (const char* name : {"none/a.npz", "none/a.obj", "none/a.vtu"}) {
        INFO(name);
        check(refusal([&] {
                  const std::string path = name;
                  if (path.ends_with("npz")) {
                      write_npz(folder / path, good_body());
                  } else if (path.ends_with("obj")) {
                      write_obj(folder / path, positions, body.faces);
                  } else {
                      write_vtu(folder / path, positions, body.faces);
                  }
              }),
              {"none"});
    }
    CHECK(folder.num_files() == 1);
    CHECK_FALSE(std::filesystem::exists(folder / "none"));
}
