// The fragment of docs/rigged_character.md about glTF files, read and not instantiated.
#include <softtissue/io/character_rig.hpp>
#include <softtissue/io/gltf_character.hpp>
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/smpl_body.hpp>

using namespace softtissue;

template <class>
Index frames_of_a_character() {
    const GltfCharacter character = read_gltf_character("hero.glb");
    const CharacterRig rig(character);
    const SmplBody<double> body = rig.body();
    const Motion<double> motion = rig.motion(character.clip("run"));
    return body.num_vertices() > 0 ? motion.num_frames() : 0;
}
