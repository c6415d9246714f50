// SPDX-License-Identifier: MIT
/// @file
/// A body of the paper's size: layers of a human whose simulated region is subdivided once, about 60,000 prisms.
///
/// What        paper_body(): body_small of the shared data if it is there, else the embedded human subdivided to that size
/// Subdivided  every edge of the skin's triangles is halved, on all levels alike; a new column is prescribed where both ends of
///             its edge lie on the same cut, and has the mean of their weights
/// Cost        seconds the first time; then read from a file in the build folder, and kept for the rest of the program
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

namespace benchmarks {

struct PaperBody {
    softtissue::LayeredBody<double> layered;  // its region is its own body: body_vertices are 0, 1, 2, ...
    softtissue::Matrix3X<double> joints;      // at rest
    softtissue::KinematicTree tree;
};

const PaperBody& paper_body();

/// Every edge halved, `times` times.
softtissue::LayeredBody<double> subdivided(softtissue::LayeredBody<double> body, int times = 1);

}  // namespace benchmarks
