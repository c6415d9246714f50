// SPDX-License-Identifier: MIT
// Every writer under every fault that can be injected without hardware: each allocation and each write fails in turn, the
// process is killed, the disk is full or read only, another process writes the same file. The file of that name is always the
// old one or the new one, whole; nothing else stays in the folder; what failed has said so.
#include "writers.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/io/output_folder.hpp>
#include <unit/io/io_test_support.hpp>

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sched.h>
#include <sys/mount.h>
#endif

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <new>
#include <string>
#include <thread>
#include <utility>

using namespace faults;
using namespace io_test;

// Allocations of this program go through here, those of the libraries that it is linked with too.
namespace {
long allocations_left = -1;  // below 0: unlimited
bool fails_once = false;     // or from then on

bool is_refused() {
    if (allocations_left < 0) {
        return false;
    }
    if (allocations_left > 0) {
        --allocations_left;
        return false;
    }
    allocations_left = fails_once ? -1 : 0;
    errno = ENOMEM;
    return true;
}
}  // namespace

#if defined(__GLIBC__)
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* malloc(size_t size) noexcept {
    return is_refused() ? nullptr : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
    return is_refused() ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) noexcept {
    return is_refused() ? nullptr : __libc_realloc(old, size);
}
}
#endif

namespace {

/// What an attempt to write says about its failure; empty if it succeeds.
std::string failure_of(const Writer& writer, const std::filesystem::path& path, int version, long allocations = -1) {
    try {
        allocations_left = allocations;
        writer.write(path, version);
    } catch (const std::exception& error) {
        allocations_left = -1;
        return error.what();
    }
    allocations_left = -1;
    return {};
}

/// Both versions, as they are without faults.
struct Versions {
    std::string bytes[3];

    explicit Versions(const Writer& writer) {
        const TemporaryFolder folder;
        for (const int version : {1, 2}) {
            writer.write(folder / writer.name, version);
            bytes[version] = read_bytes(folder / writer.name);
        }
    }
    bool has(const std::string& content) const { return content == bytes[1] || content == bytes[2]; }
};

/// Runs `work` in a process of its own; its exit code, or minus the signal that ended it.
template <class Work>
int run_apart(const Work& work) {
    const pid_t child = fork();
    if (child == 0) {
        for (const int signal : {SIGABRT, SIGSEGV}) {
            std::signal(signal, SIG_DFL);  // doctest's report belongs to its own process
        }
        int code = 1;
        try {
            code = work();
        } catch (const std::exception& error) {
            std::fprintf(stderr, "in a process of its own: %s\n", error.what());
        }
        _exit(code);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

constexpr int skipped = 77;

/// For processes apart: whether every writer refuses to replace version 1 below `folder`, with `reason`, and leaves nothing.
bool all_refuse(const std::filesystem::path& folder, const char* reason) {
    bool all = true;
    for (const Writer& writer : writers) {
        const std::filesystem::path path = folder / writer.name;
        const std::string before = read_bytes(path), text = failure_of(writer, path, 2);
        const bool is_right = contains(text, path.string() + ": cannot write: " + reason) && read_bytes(path) == before;
        if (!is_right) {
            std::fprintf(stderr, "%s: '%s', expected '%s'\n", writer.name, text.c_str(), reason);
        }
        all = all && is_right;
    }
    const auto num_files = std::distance(std::filesystem::directory_iterator(folder), {});
    return all && num_files >= std::ssize(writers) && num_files <= std::ssize(writers) + 1;  // one may fill the disk
}

/// This process may have `extra` bytes more than now.
bool limit_memory(rlim_t extra) {
    long pages = 0;
    std::FILE* const file = std::fopen("/proc/self/statm", "r");
    const bool is_known = file != nullptr && std::fscanf(file, "%ld", &pages) == 1;
    if (file != nullptr) {
        std::fclose(file);
    }
    const rlim_t bytes = rlim_t(pages) * rlim_t(sysconf(_SC_PAGESIZE)) + extra;
    const rlimit limit{bytes, bytes};
    return is_known && setrlimit(RLIMIT_AS, &limit) == 0;
}

void write_all(const std::filesystem::path& folder) {
    for (const Writer& writer : writers) {
        writer.write(folder / writer.name, 1);
    }
}

}  // namespace

#if defined(__GLIBC__)
TEST_CASE("each allocation fails in turn, alone or with all after it") {
    long faults = 0, ends = 0;
    for (const Writer& writer : writers) {
        CAPTURE(std::string(writer.name));
        const Versions versions(writer);
        const TemporaryFolder folder;
        const std::filesystem::path path = folder / writer.name;
        for (const bool once : {true, false}) {
            fails_once = once;
            writer.write(path, 1);
            bool is_written = false;
            for (long allowed = 0; !is_written; ++allowed, ++faults) {
                REQUIRE(allowed < 100000);
                int code = 0;
                if (writer.needs_json) {
                    code = run_apart([&] {
                        static_cast<void>(dup2(open("/dev/null", O_WRONLY), STDERR_FILENO));
                        return failure_of(writer, path, 2, allowed).empty() ? 0 : 1;
                    });
                    ends += code < 0 ? 1 : 0;
                } else {
                    code = failure_of(writer, path, 2, allowed).empty() ? 0 : 1;
                }
                is_written = code == 0 || (code < 0 && read_bytes(path) == versions.bytes[2]);
                REQUIRE(read_bytes(path) == versions.bytes[is_written ? 2 : 1]);
                REQUIRE(folder.num_files() <= (code < 0 ? 2 : 1));
            }
        }
    }
    MESSAGE((faults - 2 * std::ssize(writers)), " allocations have failed, ", ends, " of them ended the process");
}
#endif

TEST_CASE("each write fails in turn, by a limit to the size of files") {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit unlimited{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &unlimited) == 0);
    int faults = 0;
    for (const Writer& writer : writers) {
        CAPTURE(std::string(writer.name));
        const Versions versions(writer);
        const TemporaryFolder folder;
        writer.write(folder / writer.name, 1);
        const std::size_t size = versions.bytes[2].size();
        for (std::size_t allowed = 0; allowed < size; allowed += 1 + size / 25) {
            const rlimit limit{allowed, unlimited.rlim_max};
            REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
            const std::string text = failure_of(writer, folder / writer.name, 2);
            REQUIRE(setrlimit(RLIMIT_FSIZE, &unlimited) == 0);
            CHECK(contains(text, std::string(writer.name) + ": cannot write: File too large; allow larger files"));
            REQUIRE(read_bytes(folder / writer.name) == versions.bytes[1]);
            REQUIRE(folder.num_files() == 1);
            ++faults;
        }
        writer.write(folder / writer.name, 2);
        CHECK(read_bytes(folder / writer.name) == versions.bytes[2]);
    }
    std::signal(SIGXFSZ, SIG_DFL);
    MESSAGE(faults, " writes have failed");
}

TEST_CASE("killed at random moments") {
    RandomGenerator random(6);
    int kills = 0, left_behind = 0;
    for (const Writer& writer : writers) {
        CAPTURE(std::string(writer.name));
        const Versions versions(writer);
        const TemporaryFolder folder;
        for (int attempt = 0; attempt < 25; ++attempt) {
            const pid_t child = fork();
            if (child == 0) {
                for (int version = 1;; version = 3 - version) {
                    static_cast<void>(failure_of(writer, folder / writer.name, version));
                }
            }
            std::this_thread::sleep_for(std::chrono::microseconds(long(random.uniform(100.0, 3000.0))));
            kill(child, SIGKILL);
            int status = 0;
            REQUIRE(waitpid(child, &status, 0) == child);
            kills += WIFSIGNALED(status) ? 1 : 0;
            const bool is_there = std::filesystem::exists(folder / writer.name);
            REQUIRE((!is_there || versions.has(read_bytes(folder / writer.name))));
            const std::size_t others = folder.num_files() - (is_there ? 1 : 0);
            REQUIRE(others <= 1);  // they do not pile up
            left_behind += int(others);
        }
        writer.write(folder / writer.name, 2);
        CHECK(read_bytes(folder / writer.name) == versions.bytes[2]);
        CHECK(folder.num_files() == 1);
    }
    CHECK(kills == 25 * std::ssize(writers));
    MESSAGE(kills, " kills, ", left_behind, " of them between the first byte and the last");
}

TEST_CASE("two processes write one file, while a third reads it") {
    int reads = 0;
    for (const Writer& writer : writers) {
        CAPTURE(std::string(writer.name));
        const Versions versions(writer);
        const TemporaryFolder folder;
        writer.write(folder / writer.name, 1);
        pid_t children[2];
        for (const int version : {1, 2}) {
            children[version - 1] = fork();
            if (children[version - 1] == 0) {
                int failures = 0;
                for (int k = 0; k < 30; ++k) {
                    failures += failure_of(writer, folder / writer.name, version).empty() ? 0 : 1;
                }
                _exit(failures);
            }
        }
        for (int running = 2; running > 0; ++reads) {
            REQUIRE(versions.has(read_bytes(folder / writer.name)));
            int status = 0;
            const pid_t ended = waitpid(-1, &status, WNOHANG);
            if (ended > 0) {
                CHECK(status == 0);
                --running;
            }
        }
        CHECK(folder.num_files() == 1);
    }
    MESSAGE((60 * std::ssize(writers)), " files written against each other, ", reads, " times read");
}

TEST_CASE("little memory (ulimit -v)") {
    const TemporaryFolder folder;
    write_all(folder.path());
    int out_of_memory = 0, runs = 0;
    for (rlim_t extra = 0; extra <= 512; extra += 16, ++runs) {  // [kB]
        const int code = run_apart([&] {
            if (!limit_memory(1024 * extra)) {
                return skipped;
            }
            bool has_failed = false;
            for (const Writer& writer : writers) {
                has_failed = !failure_of(writer, folder / writer.name, 1).empty() || has_failed;
            }
            try {
                const std::vector<char> large(std::size_t(1) << 24);  // more than any of these limits
                has_failed = has_failed || large.back() != 0;
            } catch (const std::bad_alloc&) {
                return 2;
            }
            return 3;
        });
        CHECK((code == 2 || code == skipped));
        out_of_memory += code == 2 ? 1 : 0;
    }
    CHECK(folder.num_files() == std::size_t(std::ssize(writers)));
    for (const Writer& writer : writers) {
        CHECK(read_bytes(folder / writer.name) == Versions(writer).bytes[1]);
    }
    MESSAGE(out_of_memory, " of ", runs, " processes were short of memory");
}

TEST_CASE("more threads than there is memory for") {
    const int code = run_apart([] {
        if (!limit_memory(rlim_t(1) << 26)) {
            return skipped;
        }
        const std::string text = refusal([] { ThreadExecutor executor(1000); });
        Index sum = 0;
        ThreadExecutor(2).for_each_range(1, [&](Index begin, Index end) { sum += end - begin; });
        return contains(text, "threads = 1000, but the system starts no more than ") && sum == 1 ? 0 : 1;
    });
    CHECK((code == 0 || code == skipped));
}

TEST_CASE("a folder that may not be written") {
    const TemporaryFolder folder;
    write_all(folder.path());
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    const int code = run_apart([&] {
        constexpr uid_t nobody = 65534;
        if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) {
            return skipped;
        }
        const std::string text = refusal([&] { make_output_folder(folder.path()); });
        const bool says_so =
            contains(text, folder.path().string() + ": cannot write: Permission denied; choose a place");
        return says_so && all_refuse(folder.path(), "Permission denied; choose a place that you may write to") ? 0 : 1;
    });
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    CHECK((code == 0 || code == skipped));
    if (code == skipped) {
        MESSAGE("skipped: root writes everywhere, and may not become another user here");
    }
}

#if defined(__linux__)
TEST_CASE("a full disk, and one that is mounted read-only") {
    const TemporaryFolder folder;
    const int code = run_apart([&] {
        if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) {
            return skipped;
        }
        if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=1m") != 0) {
            return skipped;
        }
        write_all(folder.path());
        const int filler = open((folder / "filler").c_str(), O_CREAT | O_WRONLY, 0644);
        const std::string block(512, 'x');
        while (write(filler, block.data(), block.size()) > 0) {
        }
        close(filler);
        if (!all_refuse(folder.path(), "No space left on device; make room there and write again")) {
            return 1;
        }
        std::filesystem::remove(folder / "filler");
        for (const Writer& writer : writers) {
            if (!failure_of(writer, folder / writer.name, 2).empty()) {
                return 2;
            }
        }
        if (mount("tmpfs", folder.path().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "size=1m") != 0) {
            return skipped;
        }
        const std::string text = refusal([&] { make_output_folder(folder.path()); });
        return contains(text, "Read-only file system; choose a place that you may write to") &&
                       all_refuse(folder.path(), "Read-only file system; choose a place that you may write to")
                   ? 0
                   : 3;
    });
    CHECK((code == 0 || code == skipped));
    if (code == skipped) {
        MESSAGE("skipped: no disk can be mounted here");
    }
}
#endif
