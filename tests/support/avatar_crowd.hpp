// SPDX-License-Identifier: MIT
// Many avatars at a time: each belongs to one thread, body, mesh, model and material belong to all.
#pragma once

#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/rigged_bar.hpp>

#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace softtissue_test {

/// Where `count` avatars are after `steps`, each begun at another moment of the swing: built and stepped by `threads` threads,
/// avatar i by thread i modulo threads, all with one executor.
template <class ExecutorType = SequentialExecutor>
std::vector<Matrix3X<double>> crowd_positions(int count, int steps, int threads, const ExecutorType& executor = {}) {
    using Field = UniformField<StableNeoHookean<double>>;
    using Avatar = SoftTissueAvatar<Tet4, Field, WorldFrame, LinearBlend<double>, ExecutorType>;
    const RiggedBar<Tet4> bar(2);
    const VolumetricSmpl<double> model(bar.body);
    const Field field{StableNeoHookean<double>::from_young_poisson({2e4, 0.45})};
    std::vector<Matrix3X<double>> positions{size_t(count)};
    const auto work = [&](int first) {
        std::vector<std::pair<int, std::unique_ptr<Avatar>>> mine;
        for (int i = first; i < count; i += threads) {
            mine.emplace_back(i, std::make_unique<Avatar>(model, bar.mesh, bar.prescribed, field, executor));
        }
        for (int step = 1; step <= steps; ++step) {
            for (const auto& [i, avatar] : mine) {
                const bool is_solved = avatar->step(RiggedBar<Tet4>::swing((i + step) % 40)).succeeded();
                positions[size_t(i)] = is_solved ? avatar->positions() : Matrix3X<double>();
            }
        }
    };
    std::vector<std::thread> others;
    for (int first = 1; first < threads; ++first) {
        others.emplace_back(work, first);
    }
    work(0);
    for (std::thread& other : others) {
        other.join();
    }
    return positions;
}

}  // namespace softtissue_test
