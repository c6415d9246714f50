// SPDX-License-Identifier: MIT
// operator new that counts, for the programs of unit tests and laws. Not under the sanitizers, whose own one tells more.
#include "allocation_counter.hpp"

#include <cstdlib>
#include <new>

namespace softtissue_test {

std::atomic<std::size_t> num_allocations = 0;

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
