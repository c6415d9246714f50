// SPDX-License-Identifier: MIT
/// @file
/// Asks the processor for memory before it is needed, where the hardware does not foresee it: across pages, and in any order.
///
/// What        prefetch(from) to read, prefetch_to_write(to) to change: the cache line there
/// Valid       every address: nothing is read or written, none is an error
/// Needs       gcc or clang; nothing happens elsewhere
/// Tests       tests/unit/core/prefetch_test.cpp
#pragma once

namespace softtissue {

template <class T>
[[gnu::always_inline]] inline void prefetch([[maybe_unused]] const T* from) {
#if defined(__GNUC__)
    __builtin_prefetch(from);
#endif
}

template <class T>
[[gnu::always_inline]] inline void prefetch_to_write([[maybe_unused]] T* to) {
#if defined(__GNUC__)
    __builtin_prefetch(to, 1);
#endif
}

}  // namespace softtissue
