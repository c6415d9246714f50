// SPDX-License-Identifier: MIT
/// @file
/// A trained animation model as a value: the network and everything that its numbers mean.
///
/// What        NeuralModel: what a file holds and NeuralAnimation runs; NetworkOptions: its variants.
/// Variants    gradient   NDG: residual gradients, then a Poisson reconstruction (gradient_network.hpp). Options, as the
///                        source takes them away one by one: the matrix exponential, the bones' rotation (then the network
///                        predicts F_p itself, in the frame of the root), the shape among the inputs
///             vertex     VertexNet: offsets in the rest pose, then linear blend skinning (vertex_network.hpp)
/// Input       pose features (pose_features.hpp), then the coefficients of the shape space
/// Refuses     validate(): sizes of network, shape space and body that do not fit together (InvalidInput)
/// Source      Nolte et al. 2026, sec. 4.4, 5.2.1, 5.5
/// Tests       tests/unit/ndg/neural_model_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/ndg/body_identity.hpp>
#include <softtissue/ndg/shape_space.hpp>
#include <softtissue/nn/mlp.hpp>

#include <map>
#include <string>

namespace softtissue {

enum class NetworkKind { gradient, vertex };

struct NetworkOptions {
    NetworkKind kind = NetworkKind::gradient;
    bool exponential = true;
    bool rotation = true;
    bool shape_input = true;

    bool operator==(const NetworkOptions&) const = default;
};

template <RealScalar N>
struct NeuralModel {
    using Scalar = N;

    std::string name;  ///< of the method, in tables
    NetworkOptions options;
    Mlp<N> mlp;
    ShapeSpace<double> shape_space;
    BodyIdentity body;
    std::map<std::string, std::string> notes;  ///< how it was trained, for people

    Index num_shape_inputs() const { return options.shape_input ? shape_space.num_coefficients() : 0; }

    /// Throws InvalidInput unless all parts fit together; `source` (a file name) starts the message.
    void validate(const std::string& source) const {
        const Index pose_inputs = 9 * (Index(body.parents.size()) - 1);
        require(mlp.sizes().inputs == pose_inputs + num_shape_inputs(), source, ": a network of ", mlp.sizes().inputs,
                " inputs, expected ", pose_inputs, " of the pose and ", num_shape_inputs(), " of the shape");
        if (options.kind == NetworkKind::gradient) {
            require(mlp.sizes().outputs == 9 * body.num_cells, source, ": a network of ", mlp.sizes().outputs,
                    " outputs, expected nine for each of ", body.num_cells, " cells");
        } else {
            require(mlp.sizes().outputs % 3 == 0 && mlp.sizes().outputs <= 3 * body.num_vertices, source,
                    ": a network of ", mlp.sizes().outputs, " outputs, expected three for each free one of ",
                    body.num_vertices, " vertices");
        }
        if (options.shape_input) {
            require(shape_space.num_vertices() == body.num_vertices, source, ": a shape space of ",
                    shape_space.num_vertices(), " vertices, expected ", body.num_vertices);
        }
        require(mlp.parameters().allFinite(), source, ": a weight of the network is not finite");
    }
};

}  // namespace softtissue
