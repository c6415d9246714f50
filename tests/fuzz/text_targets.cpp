// SPDX-License-Identifier: MIT
// Readers of text.
#include "target.hpp"

#include <softtissue/io/bvh.hpp>
#include <softtissue/io/obj.hpp>

#include <array>
#include <cmath>

namespace softtissue_fuzz {

using namespace softtissue;

namespace {

void bvh(Bytes bytes) {
    const BvhClip<float> clip = read_bvh<float>(input_file("input.bvh", bytes), 0.01);
    clip.skeleton.validate("what was read");
    is_accepted([&] { clip.motion.validate("what was read", clip.skeleton.num_joints()); });
    for (const Pose<float>& pose : clip.motion.poses) {
        expect(pose.rotation_vectors.allFinite() && pose.translation.allFinite(), "a pose is finite");
    }
    for (const BvhEndSite<float>& site : clip.end_sites) {
        expect(site.position.allFinite() && site.joint < clip.skeleton.num_joints(), "an end is finite, of a joint");
    }
    expect(std::isfinite(clip.motion.frame_rate) && clip.motion.frame_rate > 0.0F, "a frame rate is finite, > 0");
}

void obj(Bytes bytes) {
    const ObjMesh<float> mesh = read_obj<float>(input_file("input.obj", bytes));
    expect(mesh.positions.allFinite(), "positions are finite");
    expect(mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.positions.cols(),
           "triangles are of vertices");
}

}  // namespace

std::span<const Target> text_targets() {
    static constexpr std::array<Target, 2> targets{{{"bvh", Container::none, bvh}, {"obj", Container::none, obj}}};
    return targets;
}

}  // namespace softtissue_fuzz
