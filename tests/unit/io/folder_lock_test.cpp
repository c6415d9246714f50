// SPDX-License-Identifier: MIT
#include <softtissue/io/folder_lock.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>
#include <vector>

using namespace softtissue;
using namespace io_test;

TEST_CASE("one at a time is in the folder, which stays as it is") {
    const TemporaryFolder folder;
    std::atomic<int> inside{0}, most{0};
    int visits = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&] {
            for (int k = 0; k < 100; ++k) {
                const FolderLock lock(folder.path());
                const int now = ++inside;
                most = now > most ? now : most.load();
                visits += 1;  // no atomic: the lock is one
                --inside;
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(most == 1);
    CHECK(visits == 400);
    CHECK(folder.num_files() == 0);
}

TEST_CASE("who does not wait is told") {
    const TemporaryFolder folder;
    {
        const FolderLock first(folder.path(), LockKind::try_once);
        CHECK(first.is_held());
        CHECK(!FolderLock(folder.path(), LockKind::try_once).is_held());
    }
    CHECK(FolderLock(folder.path(), LockKind::try_once).is_held());
}

TEST_CASE("a folder that is not there is no lock, and no error") {
    const TemporaryFolder folder;
    const FolderLock lock(folder / "none");
    CHECK(folder.num_files() == 0);
}
