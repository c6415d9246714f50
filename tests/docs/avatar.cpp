// The fragment of docs/rigged_character.md, compiled.
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/resample.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <cstddef>
#include <vector>

using namespace softtissue;

template <class>
std::vector<Matrix3X<double>> soft_tissue(const SmplBody<double>& body, const Motion<double>& recorded) {
    // Once: a layer below the skin, skinned as the skin is.
    const VolumetricSmpl<double> skin(body);
    const SoftLayer<double> layer = make_soft_layer(body);
    const auto flesh = StableNeoHookean<double>::from_young_poisson({.young_modulus = 10e3, .poisson_ratio = 0.45});
    const SequentialExecutor executor;
    SoftTissueAvatar<Prism6, UniformField<StableNeoHookean<double>>> avatar(
        make_tissue_model(skin, layer), layer.mesh, layer.prescribed_vertices, {flesh}, executor);

    // The motion at the time step of the simulation, and without corners.
    const Motion<double> motion = resample(recorded, 120.0);
    avatar.start(motion.poses[0], motion.poses[1]);
    std::vector<Matrix3X<double>> frames;
    for (std::size_t k = 2; k < motion.poses.size(); ++k) {
        const SolveReport<double> report = avatar.step(motion.poses[k]);
        if (!report.succeeded()) {
            break;  // report.status says why; the state is the best that was found
        }
        frames.push_back(avatar.positions());  // of the layer's vertices [m]
    }
    return frames;
}
