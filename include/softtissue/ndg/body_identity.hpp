// SPDX-License-Identifier: MIT
/// @file
/// What a layered body must have in common with another one for a trained model to fit both.
///
/// What        skeleton, sizes and a fingerprint of the connectivity. Rest shapes may differ: a model spans many bodies.
/// Equation    fingerprint: FNV-1a, 64 bit, over cells and prescribed vertices as little-endian 32-bit numbers
/// Valid       joint names are compared where both sides have them, parents always.
/// Refuses     require_same(): another number of joints, name, parent, vertex or cell count, connectivity
///             (InvalidInput names the first difference)
/// Tests       tests/unit/ndg/body_identity_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/byte_hash.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace softtissue {

struct BodyIdentity {
    std::vector<std::string> joint_names = {};  // empty, or one per joint
    std::vector<std::int32_t> parents = {};
    Index num_vertices = 0;
    Index num_cells = 0;
    std::uint64_t connectivity = 0;

    bool operator==(const BodyIdentity&) const = default;

    /// Throws InvalidInput unless `body` can stand in for this one; `source` (a file name) starts the message.
    void require_same(const BodyIdentity& body, const std::string& source) const {
        require(body.parents.size() == parents.size(), source, ": made for a body of ", parents.size(),
                " joints, this one has ", body.parents.size());
        for (size_t j = 0; j < parents.size(); ++j) {
            if (!joint_names.empty() && !body.joint_names.empty()) {
                require(body.joint_names[j] == joint_names[j], source, ": made for a body whose joint ", j, " is '",
                        joint_names[j], "', here it is '", body.joint_names[j], "'");
            }
            require(body.parents[j] == parents[j], source, ": made for a body whose joint ", j, " hangs from joint ",
                    parents[j], ", here from ", body.parents[j]);
        }
        require(body.num_vertices == num_vertices && body.num_cells == num_cells, source, ": made for a body of ",
                num_vertices, " vertices and ", num_cells, " cells, this one has ", body.num_vertices, " and ",
                body.num_cells);
        require(body.connectivity == connectivity, source,
                ": made for a body of the same size whose cells or prescribed vertices are others");
    }
};

/// The identity of a body; joint names may be empty.
template <RealScalar S>
BodyIdentity body_identity(const LayeredBody<S>& body, const KinematicTree& tree,
                           const std::vector<std::string>& joint_names = {}) {
    require(joint_names.empty() || Index(joint_names.size()) == tree.num_joints(),
            "body identity: ", joint_names.size(), " joint names, expected ", tree.num_joints());
    ByteHash hash;
    for (const std::int32_t v : body.mesh.cells.reshaped()) {
        hash.add_little_endian(static_cast<std::uint32_t>(v));
    }
    for (const std::int32_t v : body.prescribed) {
        hash.add_little_endian(static_cast<std::uint32_t>(v));
    }
    return {joint_names, tree.parents(), body.mesh.num_vertices(), body.mesh.num_cells(), hash.value()};
}

}  // namespace softtissue
