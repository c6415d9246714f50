// SPDX-License-Identifier: MIT
// ctest: --out retargeted_test.npz --json retargeted_test.json
//
// Carries a motion capture clip over to a body: rotations are copied, the feet stand where the performer's feet stood.
#include "retarget_motion/inputs.hpp"
#include "retarget_motion/report.hpp"
#include "support/guarded.hpp"
#include "support/progress.hpp"
#include "support/result_file.hpp"

#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/skinning/retarget.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>

namespace {

using namespace examples;

struct Settings {
    std::string body, motion, style = "smpl", out = "retargeted.npz", json;
    bool z_up = false, on_floor = false;
};

const std::map<std::string, MotionStyle> styles{{"cmu", MotionStyle::cmu},
                                                {"fair", MotionStyle::fair},
                                                {"makehuman", MotionStyle::makehuman},
                                                {"smpl", MotionStyle::smpl}};

int run_program(const Settings& settings) {
    watch_interrupt();
    require_writable(settings.out);
    const Body body = read_body(settings.body);
    const bool is_bvh = settings.motion.ends_with(".bvh");
    require(is_bvh || settings.style == "smpl", settings.motion, ": expected a .bvh file for style ", settings.style);
    require(settings.motion.empty() || !settings.body.empty() || is_bvh, "--motion without --body: expected both");
    const BvhClip<double> clip = is_bvh ? read_bvh<double>(settings.motion)
                                        : read_amass(settings.motion, settings.z_up, settings.body, body.skeleton);
    const JointMap map = smpl_joint_map(styles.at(settings.style), clip.skeleton);
    const Retargeter<double> retarget(clip.skeleton, body.skeleton, map);
    AmassClip<double> result;
    result.gender = "neutral";
    result.motion.frame_rate = clip.motion.frame_rate;
    RetargetReport<double> report;
    Progress progress("retargeting", int(clip.motion.num_frames()));
    for (const Pose<double>& pose : clip.motion.poses) {
        require(!is_interrupted(), "interrupted, nothing written");
        result.motion.poses.push_back(retarget(pose, report));
        progress.update(int(report.poses));
    }
    if (settings.on_floor) {
        place_on_floor(body, result.motion);
    }
    write_amass_clip(settings.out, result);
    std::printf("%s: %d frames at %.4g/s, scale %.5g, feet within %.1f mm of their places, %d poses not converged\n",
                settings.out.c_str(), int(report.poses), result.motion.frame_rate, retarget.scale(),
                1e3 * report.largest_foot_error, int(report.not_converged));
    if (!settings.json.empty()) {
        const nlohmann::ordered_json json{{"frames", report.poses},
                                          {"frame_rate", result.motion.frame_rate},
                                          {"scale", retarget.scale()},
                                          {"largest_foot_error_mm", 1e3 * report.largest_foot_error},
                                          {"not_converged", report.not_converged}};
        AtomicFile file(settings.json);
        file.write(json.dump(2) + "\n");
        file.commit();
    }
    const std::filesystem::path page = std::filesystem::path(settings.out).replace_extension(".html");
    if (write_report(page, {settings.body, clip, retarget, map, body.skeleton, result.motion, report})) {
        std::printf("%s\n", page.c_str());
    }
    return report.not_converged == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Carries a motion over to a body. Without arguments: the embedded motion on the embedded body.");
    app.add_option("--body", settings.body, "body in SMPL's layout (.npz)");
    app.add_option("--motion", settings.motion, "motion: .bvh, or AMASS's layout (.npz), whose pose zero is a T-pose");
    app.add_option("--style", settings.style, "whose joint names the motion has")
        ->check(CLI::IsMember({"cmu", "fair", "makehuman", "smpl"}))
        ->capture_default_str();
    app.add_flag("--z-up", settings.z_up, "the AMASS motion has z up, as the AMASS data base has");
    app.add_flag("--floor", settings.on_floor, "put the feet on y = 0");
    app.add_option("--out", settings.out, "motion in AMASS's layout")->capture_default_str();
    app.add_option("--json", settings.json, "file for figures");
    CLI11_PARSE(app, argc, argv);
    return guarded("retarget_motion", [&] { return run_program(settings); });
}
