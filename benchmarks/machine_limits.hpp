// SPDX-License-Identifier: MIT
/// @file
/// What this machine can do at most, measured in the program that asks, and what a kernel attains of it.
///
/// What        read_bandwidth(), triad_bandwidth(), fma_peak(): ceilings, in bytes and floating-point operations a second;
///             count_work(): a benchmark's rates and its fraction of the ceilings, as counters
/// Equation    fraction = bound / time of an iteration, bound = max(flops / fma_peak, bytes / bandwidth)
/// Measured    at the first question, at the kernel's own working set and number of threads, for a few hundredths of a second;
///             the best of all passes, kept for the rest of the program. Reading: 1, 4 or 8 streams, the best of them.
///             Triad: a = b + s c, three numbers an element, as many bytes as the program asks for (caches may read a as well).
///             Arithmetic: twelve independent chains of x = a x + b in registers as wide as the compiler may use.
/// Use         after the loop of a benchmark: count_work<float>(state, {.unit = "cells", .items = n, .flops = ..., .bytes_read = ...})
/// Threads     one thread asks at a time
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/thread_executor.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace benchmarks {

using softtissue::Index;

namespace detail {

using FloatPack = softtissue::Pack<float, softtissue::natural_lanes<float>>;
inline constexpr Index pack_floats = softtissue::natural_lanes<float>;
inline constexpr Index line_bytes = 64, line_floats = 16;  // a cache line

/// The shortest of at least five calls, a few hundredths of a second in all.
template <class Pass>
double best_seconds(const Pass& pass) {
    using Clock = std::chrono::steady_clock;
    double best = std::numeric_limits<double>::infinity(), total = 0;
    for (int n = 0; n < 5 || total < 0.05; ++n) {
        const Clock::time_point start = Clock::now();
        pass();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        best = std::min(best, seconds);
        total += seconds;
    }
    return best;
}

/// Adds up `streams` equal parts of the memory side by side, `lines` cache lines of each at a time. Integers: no bits are slow.
template <int streams, int lines>
void read_streams(const std::byte* memory, Index count) {
    typedef std::uint32_t Register __attribute__((vector_size(sizeof(FloatPack))));
    constexpr Index step = lines * line_bytes;
    const Index length = count / (streams * step) * step;
    Register sums[size_t(streams * lines)] = {};
    for (Index i = 0; i < length; i += step) {
        for (Index s = 0; s < streams; ++s) {
            for (Index k = 0; k < lines; ++k) {
                for (Index j = 0; j < line_bytes; j += Index(sizeof(Register))) {
                    Register values;
                    std::memcpy(&values, memory + s * length + i + k * line_bytes + j, sizeof values);
                    sums[s * lines + k] += values;
                }
            }
        }
    }
    for (int k = 1; k < streams * lines; ++k) {
        sums[0] += sums[k];
    }
    benchmark::DoNotOptimize(sums[0]);
}

inline void triad(float* a, const float* b, const float* c, Index count) {
    const FloatPack s(0.5F);
    for (Index i = 0; i + pack_floats <= count; i += pack_floats) {
        (FloatPack::load(b + i) + s * FloatPack::load(c + i)).store(a + i);
    }
    benchmark::ClobberMemory();
}

/// 24 operations a lane and step.
template <class S>
void multiply_and_add(Index steps) {
    using P = softtissue::Pack<S, softtissue::natural_lanes<S>>;
    std::array<P, 14> start;  // the compiler must not know that they are equal
    start.fill(P(S(0.5)));
    benchmark::DoNotOptimize(start);
    const P a = start[12], b = start[13];
    std::array<P, 12> x;
    std::copy_n(start.begin(), 12, x.begin());
    for (Index n = 0; n < steps; ++n) {
        for (P& value : x) {
            value = value * a + b;
        }
    }
    benchmark::DoNotOptimize(x);
}

/// The whole cache lines of some memory, as many as all ways of reading take evenly.
inline std::span<const std::byte> whole_lines(std::span<const std::byte> memory) {
    const size_t past = std::bit_cast<std::uintptr_t>(memory.data()) % size_t(line_bytes);
    const std::span<const std::byte> lines =
        memory.subspan(past == 0 ? 0 : std::min(memory.size(), size_t(line_bytes) - past));
    return lines.first(lines.size() / 1024 * 1024);
}

/// Memory of ones to measure on, as large as the largest set that was asked for; begins with a cache line.
inline std::span<float> measuring_memory(Index count) {
    static std::vector<float> memory;
    if (Index(memory.size()) < count + line_floats) {
        memory.assign(size_t(count + line_floats), 1.0F);
    }
    const size_t past = std::bit_cast<std::uintptr_t>(memory.data()) / sizeof(float) % size_t(line_floats);
    return std::span<float>(memory).subspan(past == 0 ? 0 : size_t(line_floats) - past, size_t(count));
}

/// Bytes a second of `pass(begin, end)` over lines in parts, one a thread; small sets often enough to be timed.
template <class Pass>
double bandwidth(Index lines, double bytes, int threads, const Pass& pass) {
    const softtissue::ThreadExecutor executor(threads);
    const Index repetitions = std::max(Index(1), Index(4e6 / bytes));
    return bytes * double(repetitions) / best_seconds([&] {
               executor.for_each_range(lines, [&](Index begin, Index end) {
                   for (Index n = 0; n < repetitions; ++n) {
                       pass(begin, end);
                   }
               });
           });
}

/// measure(), once for each key.
template <class Measure>
double kept(const char* what, double size, int threads, const Measure& measure) {
    static std::map<std::tuple<std::string, double, int>, double> values;
    const auto [place, is_new] = values.try_emplace({what, size, threads}, 0.0);
    if (is_new) {
        place->second = measure();
    }
    return place->second;
}

}  // namespace detail

/// Bytes a second at most in reading this memory again and again.
inline double read_bandwidth(std::span<const std::byte> memory, int threads = 1) {
    const std::span<const std::byte> lines = detail::whole_lines(memory);
    softtissue::require(!lines.empty(), "read_bandwidth: memory of ", memory.size(), " bytes, expected at least 2,048");
    return detail::kept("read", double(lines.size()), threads, [&] {
        const auto measure = [&](auto pass) {
            return detail::bandwidth(
                Index(lines.size()) / detail::line_bytes, double(lines.size()), threads, [&](Index begin, Index end) {
                    pass(lines.data() + begin * detail::line_bytes, (end - begin) * detail::line_bytes);
                });
        };
        return std::max({measure(detail::read_streams<1, 8>), measure(detail::read_streams<4, 2>),
                         measure(detail::read_streams<8, 1>)});
    });
}

/// The same for a working set of `bytes`, at least 4 KiB.
inline double read_bandwidth(double bytes, int threads = 1) {
    return read_bandwidth(std::as_bytes(detail::measuring_memory(std::max(Index(1024), Index(bytes / 4)))), threads);
}

/// Bytes a second at most in a = b + s c over a working set of `bytes`, at least 12 KiB: two are read for each one written.
inline double triad_bandwidth(double bytes, int threads = 1) {
    const Index count = std::max(Index(1024), Index(bytes / 12) / 1024 * 1024);
    return detail::kept("triad", double(count), threads, [&] {
        float* const a = detail::measuring_memory(3 * count).data();
        return detail::bandwidth(
            count / detail::line_floats, 12.0 * double(count), threads, [&](Index begin, Index end) {
                const Index first = begin * detail::line_floats;
                detail::triad(a + first, a + count + first, a + 2 * count + first, (end - begin) * detail::line_floats);
            });
    });
}

/// Operations a second at most; a multiplication with an addition counts as two.
template <class S>
double fma_peak(int threads = 1) {
    return detail::kept("flop", double(sizeof(S)), threads, [&] {
        constexpr Index steps = 20000;
        const softtissue::ThreadExecutor executor(threads);
        return 24.0 * double(softtissue::natural_lanes<S> * steps * threads) / detail::best_seconds([&] {
                   executor.for_each_range(threads, [&](Index, Index) { detail::multiply_and_add<S>(steps); });
               });
    });
}

/// What one iteration of a benchmark does. Numbers that are not known stay 0 and say nothing.
struct Work {
    const char* unit = "items";  // what is counted: cells, vertices, matrices, ...
    double items = 0;
    double flops = 0;          // a multiplication with an addition counts as two
    double bytes_read = 0;     // that must come from memory at least, each counted once
    double bytes_written = 0;  // likewise
    double working_set = 0;    // bytes that stay warm between iterations; 0: those read and written
    std::span<const std::byte> memory =
        {};  // where most of them are read from: reading is measured on it, not on as much more
    int threads = 1;
};

/// Least seconds for the work, with arithmetic in S.
template <class S>
double least_seconds(const Work& work, benchmark::State& state) {
    double least = 0;
    if (work.flops > 0) {
        const double peak = fma_peak<S>(work.threads);
        state.counters["peak flop/s"] = peak;
        least = work.flops / peak;
    }
    const double bytes = work.bytes_read + work.bytes_written;
    if (bytes > 0) {
        const double size = work.working_set > 0 ? work.working_set : bytes;
        double bandwidth =
            work.memory.empty() ? read_bandwidth(size, work.threads) : read_bandwidth(work.memory, work.threads);
        if (work.bytes_written > 0) {  // between reading only and the triad, where a third is written
            const double share = std::min(1.0, 3 * work.bytes_written / bytes);
            bandwidth += share * (triad_bandwidth(size, work.threads) - bandwidth);
        }
        state.counters["peak B/s"] = bandwidth;
        least = std::max(least, bytes / bandwidth);
    }
    return least;
}

/// Counters of a benchmark, to be set after its loop: `<unit>/s`, `flop/s`, `B/s`, the ceilings `peak flop/s` and `peak B/s`,
/// and `of limit`. S: the numbers that it computes with.
template <class S>
void count_work(benchmark::State& state, const Work& work) {
    const auto rate = [&](const std::string& name, double count) {
        if (count > 0) {
            state.counters[name] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
        }
    };
    rate(std::string(work.unit) + "/s", work.items);
    rate("flop/s", work.flops);
    rate("B/s", work.bytes_read + work.bytes_written);
    rate("of limit", least_seconds<S>(work, state));
}

}  // namespace benchmarks
