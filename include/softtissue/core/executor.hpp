// SPDX-License-Identifier: MIT
/// @file
/// Who runs a loop: the Executor concept and the sequential one.
///
/// What        an executor calls `body(begin, end)` on disjoint ranges that cover [0, count) and returns when all are done.
/// Contract    `body` writes only to slots owned by its range, so the result has the same bits for every executor.
///             An exception thrown by `body` reaches the caller; which one, if several ranges throw, is not specified.
/// Tests       tests/unit/core/executor_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <concepts>

namespace softtissue {

namespace detail {
struct AnyRangeBody {
    void operator()(Index, Index) const {}
};
}  // namespace detail

/// Runs a loop body over disjoint index ranges; see the file comment for the contract.
template <class E>
concept Executor = requires(const E& executor, Index count, detail::AnyRangeBody body) {
    { executor.for_each_range(count, body) } -> std::same_as<void>;
};

/// Runs the whole range on the calling thread.
struct SequentialExecutor {
    template <class Body>
    void for_each_range(Index count, const Body& body) const {
        if (count > 0) {
            body(Index(0), count);
        }
    }
};

}  // namespace softtissue
