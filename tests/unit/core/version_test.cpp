// SPDX-License-Identifier: MIT
#include <softtissue/core/version.hpp>

#include <doctest/doctest.h>

TEST_CASE("the version can be compared by the preprocessor") {
#if SOFTTISSUE_VERSION_MAJOR > 0 || SOFTTISSUE_VERSION_MINOR >= 1
    CHECK(SOFTTISSUE_VERSION_PATCH >= 0);
#else
    FAIL("a version below 0.1");
#endif
}
