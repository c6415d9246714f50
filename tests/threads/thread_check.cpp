// SPDX-License-Identifier: MIT
// What uses threads, for the thread sanitizer: it reports two threads that touch one place without order, and this program
// then ends with an error. Results are compared too.
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/sparse/cholesky_factor.hpp>

#include <support/avatar_crowd.hpp>
#include <support/solid_block.hpp>

#include <cstdio>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// Loops of several callers, loops in loops, an exception, threads that fall asleep in between.
bool check_executor() {
    const ThreadExecutor executor(3);
    std::vector<Index> sums(3, 0);
    const auto call = [&](size_t caller) {
        for (int k = 0; k < 50; ++k) {
            std::vector<Index> parts(8, 0);
            executor.for_each_range(8, [&](Index begin, Index end) {
                executor.for_each_range(end - begin, [&](Index from, Index to) { parts[size_t(begin)] = to - from; });
            });
            for (const Index part : parts) {
                sums[caller] += part;
            }
        }
    };
    std::vector<std::thread> callers;
    for (const size_t caller : {size_t(1), size_t(2)}) {
        callers.emplace_back(call, caller);
    }
    call(0);
    for (std::thread& caller : callers) {
        caller.join();
    }
    bool is_told = false;
    try {
        executor.for_each_range(3, [](Index begin, Index) {
            if (begin > 0) {
                throw std::runtime_error("range");
            }
        });
    } catch (const std::runtime_error&) {
        is_told = true;
    }
    return is_told && sums == std::vector<Index>{400, 400, 400};
}

bool check_avatars() {
    const ThreadExecutor shared(2);
    const std::vector<Matrix3X<double>> alone = crowd_positions(4, 3, 1, ThreadExecutor(1));
    return crowd_positions(4, 3, 4, ThreadExecutor(1)) == alone && crowd_positions(4, 3, 2, shared) == alone;
}

/// One embedding and one factor, used by two threads that have an executor each.
bool check_shared_objects() {
    const auto block = solid_block<Tet4>({.n = 3, .plan_noise = 0.1});
    const Matrix3X<double>& X = block.mesh.rest_positions;
    const ThreadExecutor builders(3);
    const Embedding<double> embedding(0.9 * X, block.mesh, builders);
    std::vector<Eigen::Triplet<double>> entries;
    const int n = 60;
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, 5.0);
        for (const int j : {(i + 1) % n, (i + 7) % n}) {
            entries.emplace_back(i, j, -1.0);
            entries.emplace_back(j, i, -1.0);
        }
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    const CholeskyFactor<double> factor(A, "ring");
    using RightHandSides = CholeskyFactor<double>::RightHandSides;
    std::vector<Matrix3X<double>> points(3, Matrix3X<double>(3, embedding.num_points()));
    std::vector<RightHandSides> solutions(3, RightHandSides::Ones(4, factor.num_places()));
    const auto work = [&](size_t who, const auto& executor) {
        embedding.apply_into(X, points[who], executor);
        factor.solve_in_place(solutions[who], executor);
    };
    work(0, ThreadExecutor(1));
    std::thread other([&] { work(1, ThreadExecutor(2)); });
    work(2, ThreadExecutor(2));
    other.join();
    return points[1] == points[0] && points[2] == points[0] && solutions[1] == solutions[0] &&
           solutions[2] == solutions[0];
}

}  // namespace

int main() {
    bool all = true;
    const auto check = [&](const char* name, bool is_right) {
        std::printf("%-20s %s\n", name, is_right ? "as on one thread" : "WRONG");
        all = all && is_right;
    };
    check("executor", check_executor());
    check("avatars", check_avatars());
    check("shared objects", check_shared_objects());
    return all ? 0 : 1;
}
