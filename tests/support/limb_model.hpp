// SPDX-License-Identifier: MIT
// Models with random weights for the layered limb.
#pragma once

#include <softtissue/ndg/body_identity.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/ndg/pose_features.hpp>

#include <support/layered_limb.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace softtissue_test {

inline KinematicTree two_joint_tree() {
    return KinematicTree({KinematicTree::no_parent, 0});
}
inline std::vector<std::string> two_joint_names() {
    return {"upper", "lower"};
}

/// Shapes: limbs thicker or longer than the usual one.
inline ShapeSpace<double> limb_shapes() {
    std::vector<Matrix3X<double>> bodies;
    for (const double length : {0.9, 1.0, 1.1}) {
        for (const double thickness : {0.9, 1.0, 1.2}) {
            bodies.push_back(Vector3<double>(length, thickness, thickness).asDiagonal() *
                             LayeredLimb<double>().body.mesh.rest_positions);
        }
    }
    return ShapeSpace<double>::from_bodies(bodies, {.max_components = 2});
}

/// The last layer is scaled: 0 predicts the same for every pose.
template <class N>
NeuralModel<N> random_limb_model(const NetworkOptions& options, double last_layer, std::uint64_t seed = 1) {
    const LayeredLimb<double> limb;
    const KinematicTree tree = two_joint_tree();
    const Index num_free = limb.body.mesh.num_vertices() - Index(limb.body.prescribed.size());
    Mlp<N> mlp({.inputs = num_pose_features(tree) + (options.shape_input ? 2 : 0),
                .hidden = {16, 8},
                .outputs = options.kind == NetworkKind::gradient ? 9 * limb.body.mesh.num_cells() : 3 * num_free});
    mlp.initialize(seed, N(last_layer));
    return {"random",
            options,
            mlp,
            options.shape_input ? limb_shapes() : ShapeSpace<double>(),
            body_identity(limb.body, tree, two_joint_names()),
            {{"samples", "0"}}};
}

}  // namespace softtissue_test
