// SPDX-License-Identifier: MIT
/// @file
/// A line on the terminal that says how far long work has come and how long it will still take; and Ctrl-C as a flag.
#pragma once

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

namespace examples {

/// Seconds since some fixed moment.
inline double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Rewrites one line on a terminal; elsewhere prints a line every tenth.
class Progress {
public:
    Progress(std::string what, int total) : what_(std::move(what)), total_(total), start_(seconds()) {}

    void update(int done) {
        const double now = seconds();
        const bool is_terminal = isatty(STDERR_FILENO) != 0;
        const bool is_due = is_terminal ? now - last_ > 0.1 : 10 * done / total_ > 10 * (done - 1) / total_;
        if (!is_due && done != total_) {
            return;
        }
        last_ = now;
        const double remaining = (now - start_) / done * (total_ - done);
        std::fprintf(stderr, "%s%s %d/%d, %.0f s left   %s", is_terminal ? "\r" : "", what_.c_str(), done, total_,
                     remaining, is_terminal && done != total_ ? "" : "\n");
        std::fflush(stderr);
    }

private:
    std::string what_;
    int total_;
    double start_;
    double last_ = 0.0;
};

namespace detail {
inline volatile std::sig_atomic_t interrupted = 0;
}

/// From now on the first Ctrl-C only raises a flag; the second one ends the program.
inline void watch_interrupt() {
    std::signal(SIGINT, [](int) {
        detail::interrupted = 1;
        std::signal(SIGINT, SIG_DFL);
    });
}
inline bool is_interrupted() {
    return detail::interrupted != 0;
}

}  // namespace examples
