// SPDX-License-Identifier: MIT
// Counts allocations: by operator new, and by Eigen, which calls malloc. For one source file of a program, before Eigen.
#pragma once

#define EIGEN_RUNTIME_NO_MALLOC
#include <Eigen/Core>

#include <cstdlib>
#include <new>

namespace softtissue_test {

inline std::size_t num_allocations = 0;

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

// Not inlined: the compiler would see malloc and free in pairs with new and delete, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++softtissue_test::num_allocations;
    if (void* const memory = std::malloc(size)) {
        return memory;
    }
    throw std::bad_alloc{};
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
