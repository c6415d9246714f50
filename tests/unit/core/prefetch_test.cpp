// SPDX-License-Identifier: MIT
#include <softtissue/core/prefetch.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

TEST_CASE("memory that is asked for stays as it is, and any address will do") {
    std::vector<double> numbers{1, 2, 3};
    const std::vector<double> before = numbers;
    prefetch(numbers.data());
    prefetch_to_write(numbers.data() + 2);
    prefetch(numbers.data() + 3);
    prefetch(static_cast<const double*>(nullptr));
    prefetch_to_write(static_cast<double*>(nullptr));
    CHECK(numbers == before);
}
