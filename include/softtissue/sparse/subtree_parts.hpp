// SPDX-License-Identifier: MIT
/// @file
/// An elimination tree cut into parts of disjoint subtrees, which several threads may work on, and a top above them.
///
/// What        the part of each node of a forest: 0 to num_parts - 1, or num_parts for the top
/// Equation    minimises work(top) + max over parts of work(part) over the cuts that are tried: again and again the largest
///             subtree gives its root to the top and falls into its children; largest subtrees first to the lightest part
/// Shapes      parents[k] > k, or negative for a root; work[k] >= 0
/// Valid       a node of a part has its whole subtree in that part. A forest of one chain is all top.
/// Source      Geist, Ng 1989, "Task scheduling for parallel sparse Cholesky factorization"
/// Tests       tests/unit/sparse/subtree_parts_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

namespace detail {

/// The lightest part for one subtree after the other, in the order given; returns the work of the heaviest.
inline double assign_subtrees(const std::vector<std::int32_t>& roots, const std::vector<double>& work, int num_parts,
                              std::vector<std::int32_t>& part) {
    std::vector<double> loads(size_t(num_parts), 0.0);
    for (const std::int32_t root : roots) {
        const auto lightest = std::min_element(loads.begin(), loads.end());
        part[size_t(root)] = static_cast<std::int32_t>(lightest - loads.begin());
        *lightest += work[size_t(root)];
    }
    return *std::max_element(loads.begin(), loads.end());
}

}  // namespace detail

inline std::vector<std::int32_t> make_subtree_parts(std::span<const std::int32_t> parents, std::span<const double> work,
                                                    int num_parts) {
    SOFTTISSUE_ASSERT(parents.size() == work.size() && num_parts > 0);
    const size_t n = parents.size();
    std::vector<double> subtree(work.begin(), work.end());
    std::vector<std::vector<std::int32_t>> children(n);
    std::vector<std::int32_t> roots;
    double total = 0;
    for (size_t k = 0; k < n; ++k) {
        const std::int32_t parent = parents[k];
        total += work[k];
        if (parent < 0) {
            roots.push_back(static_cast<std::int32_t>(k));
        } else {
            SOFTTISSUE_ASSERT(size_t(parent) > k);
            subtree[size_t(parent)] += subtree[k];
            children[size_t(parent)].push_back(static_cast<std::int32_t>(k));
        }
    }
    const auto is_heavier = [&](std::int32_t a, std::int32_t b) {
        return subtree[size_t(a)] != subtree[size_t(b)] ? subtree[size_t(a)] > subtree[size_t(b)] : a < b;
    };
    const std::int32_t top = static_cast<std::int32_t>(num_parts);
    std::vector<std::int32_t> part(n, top), best(n, top);
    double top_work = 0, least = total;
    while (!roots.empty() && top_work + (total - top_work) / num_parts < least) {
        std::sort(roots.begin(), roots.end(), is_heavier);
        const double cost = top_work + detail::assign_subtrees(roots, subtree, num_parts, part);
        if (cost < least) {
            least = cost;
            best.assign(n, -1);
            for (const std::int32_t root : roots) {
                best[size_t(root)] = part[size_t(root)];
            }
        }
        const std::int32_t split = roots.front();
        top_work += work[size_t(split)];
        roots.erase(roots.begin());
        roots.insert(roots.end(), children[size_t(split)].begin(), children[size_t(split)].end());
    }
    for (size_t k = n; k-- > 0;) {
        if (best[k] < 0) {
            best[k] = parents[k] < 0 ? top : best[size_t(parents[k])];
        }
    }
    return best;
}

}  // namespace softtissue
