// SPDX-License-Identifier: MIT
#include <softtissue/io/json_element.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace softtissue;
using namespace io_test;

namespace {

const nlohmann::json document = nlohmann::json::parse(
    R"({"a": [1, 2.5, -3, 4.0], "b": {"c": "text", "d": true, "e": null}, "long": "0123456789012345678901234567890123456789"})");

}  // namespace

TEST_CASE("values come back, with the name of their place") {
    const JsonElement root("file", document);
    CHECK(root.name() == "file");
    CHECK(root.has("a"));
    CHECK_FALSE(root.has("z"));
    const JsonElement a = root.at("a");
    CHECK(a.name() == "file: a");
    CHECK(a.size() == 4);
    CHECK(a.at(0).integer(0, 9) == 1);
    CHECK(a.at(2).integer(-3, -3) == -3);
    CHECK(a.at(3).integer(0, 9) == 4);
    CHECK(a.at(1).number() == 2.5);
    CHECK(a.numbers(4) == (VectorX<double>(4) << 1, 2.5, -3, 4).finished());
    const JsonElement b = root.at("b");
    CHECK(b.at("c").text() == "text");
    CHECK(b.at("c").name() == "file: b.c");
    CHECK(b.at("d").flag());
    CHECK(root.items("a")[1].name() == "file: a[1]");
    CHECK(root.items("z").empty());
}

TEST_CASE("everything else is refused by place, value and expectation") {
    const JsonElement root("file", document);
    const auto refused = [](const auto& read) { return refusal([&] { static_cast<void>(read()); }); };
    CHECK(refused([&] { return root.at("z"); }) == "file: z is missing");
    CHECK(refused([&] { return root.at("a").at(4); }) == "file: a has no item 4, expected 0 to 3");
    CHECK(refused([&] { return root.at("a").at(-1); }) == "file: a has no item -1, expected 0 to 3");
    CHECK(refused([&] { return root.at("a").has("x"); }) == "file: a = [4 items], expected an object");
    CHECK(refused([&] { return root.at("b").size(); }) == "file: b = {...}, expected an array");
    CHECK(refused([&] { return root.items("b"); }) == "file: b = {...}, expected an array");
    CHECK(refused([&] { return root.at("a").at(1).integer(0, 9); }) ==
          "file: a[1] = 2.5, expected an integer from 0 to 9");
    CHECK(refused([&] { return root.at("a").at(2).integer(0, 9); }) ==
          "file: a[2] = -3, expected an integer from 0 to 9");
    CHECK(refused([&] { return root.at("b").at("c").integer(0, 9); }) ==
          "file: b.c = \"text\", expected an integer from 0 to 9");
    CHECK(refused([&] { return root.at("b").at("e").number(); }) == "file: b.e = null, expected a finite number");
    CHECK(refused([&] { return root.at("b").at("d").text(); }) == "file: b.d = true, expected a text");
    CHECK(refused([&] { return root.at("b").at("c").flag(); }) == "file: b.c = \"text\", expected true or false");
    CHECK(refused([&] { return root.at("a").numbers(3); }) == "file: a = [4 items], expected an array of 3 numbers");
    CHECK(contains(refused([&] { return root.at("long").number(); }), "\"012345678901234567890123456789012345678..."));
    const nlohmann::json huge = nlohmann::json::parse("[1e300]");
    CHECK(contains(refused([&] { return JsonElement("f", huge).at(Index(0)).integer(0, 9); }), "f[0] = 1e+300"));
}
