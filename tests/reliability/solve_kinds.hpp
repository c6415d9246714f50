// SPDX-License-Identifier: MIT
// Blocks of an element with a law, for solve_trials.hpp.
#pragma once

#include "solve_trials.hpp"

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/linalg/quaternion.hpp>

#include <support/solid_block.hpp>

#include <algorithm>
#include <cmath>

namespace reliability {

/// Makes the cells of the unit cube bad, in the way that `shape` says, without turning one over.
template <class ElementType>
void spoil(CellMesh<ElementType, double>& mesh, Shape shape, int levels, RandomGenerator& random) {
    Matrix3X<double>& X = mesh.rest_positions;
    if (shape == Shape::slender) {
        X.row(random.index(3)) *= std::pow(10, -random.uniform(0, 6));
    } else if (shape == Shape::thin) {
        // the levels keep their order: each lies a random thickness above the one below
        std::vector<double> heights{0};
        for (int level = 0; level < levels; ++level) {
            heights.push_back(heights.back() + std::pow(10, -random.uniform(2, 9)));
        }
        for (double& z : X.row(2)) {
            const double level = z * levels;
            const size_t below = std::min(size_t(std::max(level, 0.0)), heights.size() - 2);
            z = heights[below] + (level - double(below)) * (heights[below + 1] - heights[below]);
        }
    } else if (shape == Shape::slivers) {
        // node 0 of some cells towards the middle of the others, as far as every cell around it allows
        for (int k = 0; k < 3; ++k) {
            const Index c = random.index(mesh.num_cells());
            const std::int32_t v = mesh.cells(0, c);
            const Vector3<double> start = X.col(v);
            const Vector3<double> target =
                (mesh.rest_nodes(c).rowwise().sum() - start) / double(ElementType::num_nodes - 1);
            const double goal = 1 - std::pow(10, -random.uniform(1, 6));
            for (double part = goal; part > 1e-3; part *= 0.9) {
                X.col(v) = start + part * (target - start);
                if (mesh.count_inverted(X) == 0) {
                    break;
                }
                X.col(v) = start;
            }
        }
    }
}

/// `make_field(mesh, tissue)` makes the law of every cell.
template <class ElementType, class S, class MakeField>
BlockMaker<S> block_maker(const MakeField& make_field) {
    return [make_field](Shape shape, const Tissue& tissue, RandomGenerator& random) {
        const int n = 2;
        softtissue_test::SolidBlock<ElementType, double> block = softtissue_test::solid_block<ElementType, double>(
            {.n = n, .plan_noise = 0.05, .level_noise = 0.03, .seed = random.bits()});
        spoil(block.mesh, shape, n, random);
        const CellMesh<ElementType, S> mesh{block.mesh.rest_positions.template cast<S>(), block.mesh.cells};
        using Field = decltype(make_field(mesh, tissue));
        return TrialBlock<S>{
            mesh.rest_positions, lumped_masses(mesh, S(1000)), block.bottom, block.top,
            std::make_unique<HeldElastic<ElasticEnergy<ElementType, Field>>>(mesh, make_field(mesh, tissue))};
    };
}

/// A rotation for each cell.
template <class S>
std::vector<Matrix3<S>> random_rotations(Index count, double size, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<Matrix3<S>> result;
    for (Index c = 0; c < count; ++c) {
        const Vector3<double> r = size * Vector3<double>(random.normal(), random.normal(), random.normal());
        result.push_back(rotation_matrix_from_rotation_vector<double>(r).template cast<S>());
    }
    return result;
}

}  // namespace reliability
