// The three macros replaced by a user: asserts become exceptions, and the text of every throw is seen on its way.
#include <stdexcept>
#include <string>

namespace {

struct AssertionFailed : std::logic_error {
    using std::logic_error::logic_error;
};

std::string last_thrown_text;

template <class Error>
[[noreturn]] void throw_and_remember(const std::string& text) {
    last_thrown_text = text;
    throw Error(text);
}

}  // namespace

#define SOFTTISSUE_ASSERT(condition) ((condition) ? void() : throw AssertionFailed(#condition))
#define SOFTTISSUE_THROW(type, text) throw_and_remember<type>(text)

#include <softtissue/core/config.hpp>

#include <doctest/doctest.h>

namespace {

int checked_index(int index, int size) {
    SOFTTISSUE_ASSERT(index < size);
    return index;
}

}  // namespace

TEST_CASE("a user's SOFTTISSUE_ASSERT replaces the default") {
    CHECK(checked_index(2, 3) == 2);
    CHECK_THROWS_WITH_AS(checked_index(3, 3), "index < size", AssertionFailed);
}

TEST_CASE("a user's SOFTTISSUE_THROW replaces the default") {
    const auto fail = [] { SOFTTISSUE_THROW(std::runtime_error, "why"); };
    CHECK_THROWS_WITH_AS(fail(), "why", std::runtime_error);
    CHECK(last_thrown_text == "why");
}
