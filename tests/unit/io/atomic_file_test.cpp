// SPDX-License-Identifier: MIT
#include <softtissue/io/atomic_file.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <iterator>
#include <string>

using namespace softtissue;
using namespace io_test;

TEST_CASE("a committed file has its content, and nothing else remains") {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.txt");
    file.write("hello ");
    file.write("world", 5);
    CHECK(!std::filesystem::exists(folder / "a.txt"));
    file.commit();
    CHECK(read_bytes(folder / "a.txt") == "hello world");
    CHECK(folder.num_files() == 1);
}

TEST_CASE("a file that is not committed leaves the older one as it was") {
    const TemporaryFolder folder;
    write_bytes(folder / "a.txt", "old");
    {
        AtomicFile file(folder / "a.txt");
        file.write("new");
    }
    CHECK(read_bytes(folder / "a.txt") == "old");
    CHECK(folder.num_files() == 1);
    AtomicFile file(folder / "a.txt");
    file.write("new");
    file.commit();
    CHECK(read_bytes(folder / "a.txt") == "new");
}

TEST_CASE("two writers of one name do not share their temporary file") {
    const TemporaryFolder folder;
    AtomicFile first(folder / "a.txt");
    AtomicFile second(folder / "a.txt");
    CHECK(first.temporary_path() != second.temporary_path());
    first.write("1");
    second.write("2");
    second.commit();
    first.commit();
    CHECK(read_bytes(folder / "a.txt") == "1");
    CHECK(folder.num_files() == 1);
}

TEST_CASE("content written by name is committed, an empty file is a file") {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.txt");
    write_bytes(file.temporary_path(), "by name");
    file.commit();
    CHECK(read_bytes(folder / "a.txt") == "by name");
    AtomicFile(folder / "empty").commit();
    CHECK(std::filesystem::file_size(folder / "empty") == 0);
}

TEST_CASE("places that cannot be written are refused by name") {
    const TemporaryFolder folder;
    const std::string no_folder = refusal([&] { AtomicFile file(folder / "none/a.txt"); });
    CHECK(contains(no_folder, "none/a.txt: cannot write"));
    const std::string is_folder = refusal([&] { AtomicFile file(folder.path()); });
    CHECK(contains(is_folder, folder.path().string() + ": cannot write, expected the name of a file"));
    CHECK(contains(refusal([] { AtomicFile file(""); }), "expected the name of a file"));
    CHECK(folder.num_files() == 0);
}

TEST_CASE("what killed writers have left is taken over, what living ones write is not") {
    const TemporaryFolder folder;
    write_bytes(folder / "a.txt.part0", "half a file, longer than the next");
    AtomicFile first(folder / "a.txt");
    CHECK(first.temporary_path() == folder / "a.txt.part0");
    AtomicFile second(folder / "a.txt");
    CHECK(second.temporary_path() == folder / "a.txt.part1");
    first.write("first");
    first.commit();
    CHECK(read_bytes(folder / "a.txt") == "first");
    AtomicFile third(folder / "a.txt");
    CHECK(third.temporary_path() == folder / "a.txt.part0");
    third.commit();
    CHECK(std::filesystem::file_size(folder / "a.txt") == 0);
    second.commit();
    CHECK(folder.num_files() == 1);
}

TEST_CASE("a link stays a link, the file behind it is replaced") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "far");
    write_bytes(folder / "far/a.txt", "old");
    std::filesystem::create_symlink("far/a.txt", folder / "link");
    AtomicFile file(folder / "link");
    file.write("new");
    file.commit();
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(read_bytes(folder / "far/a.txt") == "new");
    CHECK(std::distance(std::filesystem::directory_iterator(folder / "far"), {}) == 1);
}

#if defined(__linux__)
TEST_CASE("a full disk is noticed before the file appears") {
    // /dev/full takes every byte and fails when they are flushed; the temporary file is made to lead there.
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.txt");
    std::filesystem::remove(file.temporary_path());
    std::filesystem::create_symlink("/dev/full", file.temporary_path());
    const std::string text = refusal([&] {
        file.write("x");
        file.commit();
    });
    CHECK(contains(text, "a.txt: cannot write: No space left on device"));
    CHECK(!std::filesystem::exists(folder / "a.txt"));
}

TEST_CASE("a device is not replaced by a file") {
    for (const char* device : {"/dev/null", "/dev/full"}) {
        const std::string text = refusal([&] { AtomicFile file(device); });
        CHECK(contains(text,
                       std::string(device) + ": cannot write, expected the name of a file, not of a folder or device"));
        CHECK(std::filesystem::is_character_file(device));
    }
}
#endif
