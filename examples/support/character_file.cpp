// SPDX-License-Identifier: MIT
#include "character_file.hpp"

#include <softtissue/io/character_rig.hpp>
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/io/joint_names_file.hpp>
#include <softtissue/mesh/validate_surface.hpp>

#include <cstdio>

namespace examples {

using namespace softtissue;

namespace {

/// What the file says and the simulation leaves out.
void print_changes(const GltfCharacter& character, const BoneChange& bones) {
    const GltfRepairs& repairs = character.repairs;
    const char* source = character.source.c_str();
    if (repairs.rescaled_vertices > 0) {
        std::fprintf(stderr, "%s: the weights of %d vertices do not sum to one (by up to %.2g); divided by their sum\n",
                     source, int(repairs.rescaled_vertices), repairs.largest_sum_error);
    }
    if (repairs.largest_weight_difference > 0.02) {
        std::fprintf(stderr,
                     "%s: vertices at the same place differ in their weights (by up to %.2g); their mean is taken\n",
                     source, repairs.largest_weight_difference);
    }
    if (!character.hole_centers.empty()) {
        std::fprintf(stderr, "%s: %d holes are closed; their rims carry no tissue\n", source,
                     int(character.hole_centers.size()));
    }
    if (bones.shift > 1e-3 || bones.stretch > 1e-3) {
        std::fprintf(
            stderr,
            "%s: the clip pulls bones apart by up to %.2g m (joint '%s') and stretches them by up to %.2g; they are "
            "held rigid\n",
            source, bones.shift, bones.shifted_joint.c_str(), bones.stretch);
    }
}

}  // namespace

bool is_character_file(const std::string& path) {
    return path.ends_with(".glb") || path.ends_with(".gltf");
}

CharacterScene read_character(const std::string& path, const CharacterChoice& choice) {
    const GltfCharacter character = read_gltf_character(path, {.mesh = choice.mesh, .fill_holes = true});
    require(!character.clips.empty(), character.source, ": has no animation, expected a clip to play");
    const GltfClip& clip = choice.clip.empty() ? character.clips.front() : character.clip(choice.clip);
    try {
        validate_closed_surface(character.positions, character.triangles, character.source);
    } catch (const InvalidInput& error) {
        throw_invalid_input(
            error.what(),
            "; soft tissue needs a surface that encloses it: remove inner and double faces before export, or name "
            "another mesh by --mesh");
    }
    const CharacterRig rig(character);
    CharacterScene scene{rig.body(), rig.motion(clip), {}, character.hole_centers};
    if (!choice.joints.empty()) {
        scene.extremities = smpl_extremities_of(rig.tree(), read_joint_names(choice.joints, scene.body.joint_names));
    }
    print_changes(character, rig.bone_change(clip));
    std::fprintf(stderr, "%s: clip '%s', %.3g s; %d of %d joints move bones, %d vertices of the file are %d places\n",
                 character.source.c_str(), clip.name.c_str(), clip.duration(), int(rig.num_joints()),
                 int(character.num_joints()), int(character.welded_vertex.size()), int(character.num_vertices()));
    return scene;
}

}  // namespace examples
