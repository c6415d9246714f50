#include <softtissue/core/executor.hpp>
#include <softtissue/core/thread_executor.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(Executor<ThreadExecutor>);
static_assert(!std::is_copy_constructible_v<ThreadExecutor>);
static_assert(std::is_nothrow_move_constructible_v<ThreadExecutor>);

TEST_CASE("every index is visited once, whatever the counts of indices and threads") {
    for (const int threads : {1, 2, 3, 7}) {
        const ThreadExecutor executor(threads);
        CHECK(executor.num_threads() == threads);
        for (const Index count : {Index(0), Index(1), Index(2), Index(6), Index(7), Index(8), Index(1000)}) {
            std::vector<int> visits(std::size_t(count), 0);
            std::atomic<int> ranges{0};
            executor.for_each_range(count, [&](Index begin, Index end) {
                ++ranges;
                for (Index i = begin; i < end; ++i) {
                    ++visits[std::size_t(i)];
                }
            });
            CHECK(visits == std::vector<int>(std::size_t(count), 1));
            CHECK(ranges == std::min(Index(threads), count));
        }
    }
}

TEST_CASE("a negative count is an empty loop") {
    const ThreadExecutor executor(2);
    executor.for_each_range(-3, [](Index, Index) { FAIL_CHECK("the body of an empty loop ran"); });
}

TEST_CASE("ranges are contiguous and equal to within one") {
    const ThreadExecutor executor(3);
    std::vector<Index> sizes(11, 0);
    executor.for_each_range(11, [&](Index begin, Index end) { sizes[std::size_t(begin)] = end - begin; });
    CHECK(sizes == std::vector<Index>{3, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0});
}

TEST_CASE("the same bits for 1, 2 and 7 threads") {
    const auto run = [](const auto& executor) {
        std::vector<double> values(10000);
        executor.for_each_range(Index(values.size()), [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                values[std::size_t(i)] = std::sin(double(i)) / (1.0 + double(i));
            }
        });
        return values;
    };
    const std::vector<double> expected = run(SequentialExecutor{});
    for (const int threads : {1, 2, 7}) {
        CHECK(run(ThreadExecutor(threads)) == expected);
    }
}

TEST_CASE("the calling thread takes the first range, the others run elsewhere and stay the same") {
    const ThreadExecutor executor(2);
    const auto threads_of_loop = [&] {
        std::vector<std::thread::id> ids(2);
        executor.for_each_range(2, [&](Index begin, Index) { ids[std::size_t(begin)] = std::this_thread::get_id(); });
        return ids;
    };
    const std::vector<std::thread::id> first = threads_of_loop();
    CHECK(first[0] == std::this_thread::get_id());
    CHECK(first[1] != first[0]);
    CHECK(threads_of_loop() == first);
}

TEST_CASE("an exception reaches the caller after all ranges are done, and the executor stays usable") {
    const ThreadExecutor executor(4);
    for (int repetition = 0; repetition < 20; ++repetition) {
        std::atomic<int> finished{0};
        std::string text;
        try {
            executor.for_each_range(4, [&](Index begin, Index) {
                if (begin == 1 || begin == 3) {
                    throw std::runtime_error("range " + std::to_string(begin));
                }
                ++finished;
            });
        } catch (const std::runtime_error& error) {
            text = error.what();
        }
        CHECK(text == "range 1");
        CHECK(finished == 2);
    }
    std::atomic<Index> sum{0};
    executor.for_each_range(100, [&](Index begin, Index end) { sum += end - begin; });
    CHECK(sum == 100);
}

TEST_CASE("a loop inside a loop of the same executor runs whole on its thread") {
    const ThreadExecutor executor(3);
    std::vector<Index> lengths(3, 0);
    executor.for_each_range(3, [&](Index outer, Index) {
        executor.for_each_range(50, [&](Index begin, Index end) { lengths[std::size_t(outer)] = end - begin; });
    });
    CHECK(lengths == std::vector<Index>{50, 50, 50});
}

TEST_CASE("loops of several calling threads follow one another") {
    const ThreadExecutor executor(2);
    Index sum = 0;  // no atomic: only one loop runs at a time
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 3; ++caller) {
        callers.emplace_back([&] {
            for (int repetition = 0; repetition < 200; ++repetition) {
                executor.for_each_range(8, [&](Index begin, Index end) {
                    if (begin == 0) {
                        sum += end;
                    }
                });
            }
        });
    }
    for (std::thread& caller : callers) {
        caller.join();
    }
    CHECK(sum == 3 * 200 * 4);
}

TEST_CASE("many short loops, with pauses in which the workers fall asleep") {
    const ThreadExecutor executor(3);
    std::vector<int> count(3, 0);
    for (int repetition = 0; repetition < 2000; ++repetition) {
        executor.for_each_range(3, [&](Index begin, Index) { ++count[std::size_t(begin)]; });
        if (repetition % 500 == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
    CHECK(count == std::vector<int>{2000, 2000, 2000});
}

TEST_CASE("fewer than one thread is refused") {
    CHECK_THROWS_WITH_AS(ThreadExecutor(0), "threads = 0, expected at least 1", InvalidInput);
    CHECK_THROWS_WITH_AS(ThreadExecutor(-2), "threads = -2, expected at least 1", InvalidInput);
}
