// SPDX-License-Identifier: MIT
#include "character_file.hpp"

#include <softtissue/io/character_rig.hpp>
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/io/joint_names_file.hpp>
#include <softtissue/mesh/validate_surface.hpp>

#include <cstdio>

namespace examples {

using namespace softtissue;

bool is_character_file(const std::string& path) {
    return path.ends_with(".glb") || path.ends_with(".gltf");
}

CharacterScene read_character(const std::string& path, const CharacterChoice& choice) {
    const GltfCharacter character = read_gltf_character(path, {.mesh = choice.mesh});
    require(!character.clips.empty(), character.source, ": has no animation, expected a clip to play");
    const GltfClip& clip = choice.clip.empty() ? character.clips.front() : character.clip(choice.clip);
    try {
        validate_closed_surface(character.positions, character.triangles, character.source);
    } catch (const InvalidInput& error) {
        throw_invalid_input(
            error.what(),
            "; soft tissue needs a surface that encloses it: close the holes (eyes, mouth, neck, cuffs) and "
            "remove inner and double faces before export, or name another mesh by --mesh");
    }
    const CharacterRig rig(character);
    CharacterScene scene{rig.body(), rig.motion(clip), {}};
    if (!choice.joints.empty()) {
        scene.extremities = smpl_extremities_of(rig.tree(), read_joint_names(choice.joints, scene.body.joint_names));
    }
    std::fprintf(stderr, "%s: clip '%s', %.3g s; %d of %d joints move bones, %d vertices of the file are %d places\n",
                 character.source.c_str(), clip.name.c_str(), clip.duration(), int(rig.num_joints()),
                 int(character.num_joints()), int(character.welded_vertex.size()), int(character.num_vertices()));
    return scene;
}

}  // namespace examples
