// SPDX-License-Identifier: MIT
#include <softtissue/io/pvd.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace softtissue;
using namespace io_test;

TEST_CASE("a series lists its files and times exactly") {
    const TemporaryFolder folder;
    write_pvd(folder / "a.pvd", {{0.0, "frame_0.vtu"}, {1.0 / 120.0, "a&b.vtu"}});
    const std::string text = read_bytes(folder / "a.pvd");
    CHECK(text.starts_with("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\""));
    CHECK(contains(text, "<DataSet timestep=\"0\" part=\"0\" file=\"frame_0.vtu\"/>"));
    CHECK(contains(text, "file=\"a&amp;b.vtu\"/>"));
    const std::size_t second = text.find("timestep=\"", text.find("timestep=\"") + 1) + 10;
    CHECK(std::stod(text.substr(second)) == 1.0 / 120.0);
    CHECK(text.ends_with("</Collection>\n</VTKFile>\n"));
    CHECK(folder.num_files() == 1);
}

TEST_CASE("a series that cannot be written is refused by name") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([&] { write_pvd(folder / "none/a.pvd", {}); }), "none/a.pvd: cannot write"));
}
