// SPDX-License-Identifier: MIT
#include <softtissue/io/output_folder.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

using namespace softtissue;
using namespace io_test;

TEST_CASE("a folder is made with those above it, left empty, and may be there already") {
    const TemporaryFolder folder;
    make_output_folder(folder / "a/b");
    CHECK(std::filesystem::is_empty(folder / "a/b"));
    write_bytes(folder / "a/b/result", "old");
    make_output_folder(folder / "a/b");
    CHECK(read_bytes(folder / "a/b/result") == "old");
    CHECK(std::filesystem::exists(folder / "a/b/.softtissue_trial") == false);
}

TEST_CASE("what is no folder, or lies below a file, is refused by name") {
    const TemporaryFolder folder;
    write_bytes(folder / "file", "content");
    CHECK(contains(refusal([&] { make_output_folder(folder / "file"); }), "file: cannot write"));
    CHECK(contains(refusal([&] { make_output_folder(folder / "file/below"); }), "below: cannot write"));
    CHECK(contains(refusal([&] { make_output_folder(""); }), "cannot write"));
    CHECK(read_bytes(folder / "file") == "content");
}
