// SPDX-License-Identifier: MIT
#include <softtissue/core/byte_hash.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("the values of FNV-1a") {
    CHECK(ByteHash().value() == 0xcbf29ce484222325U);
    CHECK(ByteHash().add("a", 1).value() == 0xaf63dc4c8601ec8cU);
    CHECK(ByteHash().add("foo", 3).add("bar", 3).value() == 0x85944171f73967e8U);
}

TEST_CASE("a number is its bytes, the lowest first") {
    CHECK(ByteHash().add_little_endian(0x64636261U).value() == ByteHash().add("abcd", 4).value());
}
