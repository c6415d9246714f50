// SPDX-License-Identifier: MIT
/// @file
/// The outermost layer of a program: what goes wrong inside becomes one line on stderr and an exit code.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace examples {

/// Runs `work()`, which gives the exit code; 1 where it throws, or where its output could not be printed.
template <class Work>
int guarded(const char* program, const Work& work) {
    try {
        const int code = work();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
            std::fprintf(stderr, "%s: cannot print: %s; the files are complete\n", program, std::strerror(errno));
            return 1;
        }
        return code;
    } catch (const std::bad_alloc&) {
        std::fprintf(
            stderr,
            "%s: out of memory; files that are there are complete. Fewer threads, frames or samples need less, "
            "or allow more (ulimit -v)\n",
            program);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
    }
    return 1;
}

}  // namespace examples
