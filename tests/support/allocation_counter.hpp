// SPDX-License-Identifier: MIT
// Counts allocations: by operator new, which allocation_counter.cpp replaces, and by Eigen, which calls malloc.
#pragma once

#include <Eigen/Core>

#include <atomic>
#include <cstddef>

namespace softtissue_test {

extern std::atomic<std::size_t> num_allocations;

/// While it lives Eigen asserts that it does not allocate, and operator new is counted.
class AllocationCounter {
public:
    AllocationCounter() : before_(num_allocations) { Eigen::internal::set_is_malloc_allowed(false); }
    ~AllocationCounter() { Eigen::internal::set_is_malloc_allowed(true); }
    AllocationCounter(const AllocationCounter&) = delete;
    AllocationCounter& operator=(const AllocationCounter&) = delete;

    std::size_t count() const { return num_allocations - before_; }

private:
    std::size_t before_;
};

}  // namespace softtissue_test
