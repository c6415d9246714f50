// SPDX-License-Identifier: MIT
#include <softtissue/io/file_claim.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cerrno>
#include <type_traits>
#include <utility>

using namespace softtissue;
using namespace io_test;

static_assert(!std::is_copy_constructible_v<FileClaim>);
static_assert(std::is_nothrow_move_constructible_v<FileClaim>);

TEST_CASE("a file is made, and is nobody else's while the claim lives") {
    const TemporaryFolder folder;
    {
        const FileClaim claim(folder / "a");
        CHECK(claim.is_held());
        CHECK(claim.error() == 0);
        CHECK(std::filesystem::file_size(folder / "a") == 0);
        const FileClaim other(folder / "a");
        CHECK(!other.is_held());
        CHECK(other.error() == EEXIST);
        CHECK(!remove_abandoned(folder / "a"));
    }
    CHECK(std::filesystem::exists(folder / "a"));
}

TEST_CASE("what lies there without an owner is taken over and emptied") {
    const TemporaryFolder folder;
    write_bytes(folder / "a", "left behind");
    FileClaim claim(folder / "a");
    CHECK(claim.is_held());
    CHECK(std::filesystem::file_size(folder / "a") == 0);

    FileClaim moved(std::move(claim));
    CHECK(moved.is_held());
    CHECK(!FileClaim(folder / "a").is_held());
    moved = FileClaim();
    CHECK(!moved.is_held());
    CHECK(FileClaim(folder / "a").is_held());
}

TEST_CASE("taking over makes nothing") {
    const TemporaryFolder folder;
    const FileClaim claim(folder / "a", ClaimKind::take_over);
    CHECK(!claim.is_held());
    CHECK(claim.error() == ENOENT);
    CHECK(!remove_abandoned(folder / "a"));
    CHECK(folder.num_files() == 0);
}

TEST_CASE("an abandoned file is removed") {
    const TemporaryFolder folder;
    write_bytes(folder / "a", "left behind");
    CHECK(remove_abandoned(folder / "a"));
    CHECK(folder.num_files() == 0);
}

TEST_CASE("folders and links are nobody's files") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "sub");
    write_bytes(folder / "target", "content");
    std::filesystem::create_symlink("target", folder / "link");
    CHECK(FileClaim(folder / "sub").error() == EEXIST);
    CHECK(FileClaim(folder / "link").error() == EEXIST);
    CHECK(!remove_abandoned(folder / "link"));
    CHECK(read_bytes(folder / "target") == "content");
    CHECK(FileClaim(folder / "none/a").error() == ENOENT);
}
