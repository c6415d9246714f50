// SPDX-License-Identifier: MIT
/// @file
/// An executor with a pool of persistent threads.
///
/// What        [0, count) in one contiguous range per thread, equal to within one; the calling thread takes the first.
/// Contract    that of Executor. Of several exceptions the one of the lowest range is rethrown, after all ranges are done.
/// Sharing     one loop at a time: a second calling thread waits for the first. A loop started by the body of another
///             loop of the same executor runs whole on the thread that starts it.
/// Refuses     threads < 1, more than the system starts (InvalidInput).
/// Cost        a few microseconds a loop while loops follow each other closely, a thread wake-up otherwise.
/// Needs       exceptions, and a thread library to link (CMake: Threads::Threads).
/// Tests       tests/unit/core/thread_executor_test.cpp
#pragma once

#if !defined(__cpp_exceptions) && !defined(_CPPUNWIND)
#error "softtissue: core/thread_executor.hpp needs exceptions; without them, leave it out"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace softtissue {

class ThreadExecutor {
public:
    /// `threads` counts the calling thread: threads - 1 are started, and joined by the destructor.
    explicit ThreadExecutor(int threads) {
        require(threads >= 1, "threads = ", threads, ", expected at least 1");
        pool_ = std::make_unique<Pool>(threads);
        pool_->start();
    }

    int num_threads() const { return pool_->num_threads; }

    template <class Body>
    void for_each_range(Index count, const Body& body) const {
        if (count <= 0) {
            return;
        }
        if (pool_->num_threads == 1 || pool_->is_running_on_this_thread()) {
            body(Index(0), count);
            return;
        }
        const auto call = [](const void* erased, Index begin, Index end) {
            (*static_cast<const Body*>(erased))(begin, end);
        };
        pool_->run({call, std::addressof(body), count});
    }

private:
    struct Loop {
        void (*call)(const void* body, Index begin, Index end) = nullptr;
        const void* body = nullptr;
        Index count = 0;
    };

    /// Workers sleep on `generation`, the caller on `unfinished`: a loop is published by raising the first, and is
    /// over when the second reaches zero. In between `loop` is only read, and each error slot has one writer.
    struct Pool {
        explicit Pool(int threads) : num_threads(threads), errors(std::size_t(threads)) {}
        Pool(const Pool&) = delete;
        Pool& operator=(const Pool&) = delete;

        ~Pool() {
            loop = {};  // a worker that finds no body to call returns
            publish();
            for (std::thread& worker : workers) {
                worker.join();
            }
        }

        void start() {
            workers.reserve(errors.size() - 1);
            for (int part = 1; part < num_threads; ++part) {
                try {
                    workers.emplace_back([this, part] { work(part); });
                } catch (const std::system_error& error) {
                    throw_invalid_input("threads = ", num_threads, ", but the system starts no more than ", part, " (",
                                        error.code().message(), "), expected fewer, or more memory for each");
                }
            }
        }

        bool is_running_on_this_thread() const {
            const std::thread::id self = std::this_thread::get_id();
            if (caller.load(std::memory_order_relaxed) == self) {
                return true;
            }
            for (const std::thread& worker : workers) {
                if (worker.get_id() == self) {
                    return true;
                }
            }
            return false;
        }

        void run(const Loop& next) {
            const std::lock_guard<std::mutex> one_loop_at_a_time(mutex);
            caller.store(std::this_thread::get_id(), std::memory_order_relaxed);
            loop = next;
            unfinished.store(num_threads - 1, std::memory_order_relaxed);
            publish();
            run_part(0);
            for (int left = spin_while(unfinished, [](int value) { return value != 0; }); left != 0;
                 left = unfinished.load(std::memory_order_acquire)) {
                unfinished.wait(left, std::memory_order_acquire);
            }
            caller.store(std::thread::id(), std::memory_order_relaxed);
            rethrow_first_error();
        }

        void publish() {
            generation.fetch_add(1, std::memory_order_release);
            generation.notify_all();
        }

        void work(int part) {
            for (int seen = 0;;) {
                spin_while(generation, [seen](int value) { return value == seen; });
                generation.wait(seen, std::memory_order_acquire);
                seen = generation.load(std::memory_order_acquire);
                if (loop.call == nullptr) {
                    return;
                }
                run_part(part);
                if (unfinished.fetch_sub(1, std::memory_order_acq_rel) == 1) {
                    unfinished.notify_one();
                }
            }
        }

        void run_part(int part) {
            const Index begin = loop.count * part / num_threads;
            const Index end = loop.count * (part + 1) / num_threads;
            if (begin == end) {
                return;
            }
            try {
                loop.call(loop.body, begin, end);
            } catch (...) {
                errors[std::size_t(part)] = std::current_exception();
            }
        }

        void rethrow_first_error() {
            std::exception_ptr first;
            for (std::exception_ptr& error : errors) {
                if (error != nullptr && first == nullptr) {
                    first = error;
                }
                error = nullptr;
            }
            if (first != nullptr) {
                std::rethrow_exception(first);
            }
        }

        /// Looks at `value` for a few microseconds, less than a thread needs to fall asleep and wake up.
        template <class Condition>
        static int spin_while(const std::atomic<int>& value, const Condition& condition) {
            int now = value.load(std::memory_order_acquire);
            for (int look = 0; look < 4000 && condition(now); ++look) {
                now = value.load(std::memory_order_acquire);
            }
            return now;
        }

        const int num_threads;
        std::vector<std::exception_ptr> errors;
        std::vector<std::thread> workers;
        std::mutex mutex;
        Loop loop;
        std::atomic<int> generation{0};
        std::atomic<int> unfinished{0};
        std::atomic<std::thread::id> caller{};
    };

    std::unique_ptr<Pool> pool_;
};

}  // namespace softtissue
