// SPDX-License-Identifier: MIT
#include <softtissue/io/write_failure.hpp>

#include <doctest/doctest.h>

#include <cerrno>

using namespace softtissue;

TEST_CASE("a failure names the file, the system's reason and what to do") {
    CHECK(write_failure("a/b.npz", ENOSPC) ==
          "a/b.npz: cannot write: No space left on device; make room there and write again");
    CHECK(write_failure("b", EROFS) == "b: cannot write: Read-only file system; choose a place that you may write to");
    CHECK(write_failure("b", ENOENT) == "b: cannot write: No such file or directory; make its folder first");
    CHECK(write_failure("b", EFBIG) ==
          "b: cannot write: File too large; allow larger files (ulimit -f) and write again");
}

TEST_CASE("without advice, and without a reason, the rest is said") {
    CHECK(write_failure("b", EIO) == "b: cannot write: Input/output error");
    CHECK(write_failure("b", 0) == "b: cannot write");
}
