// SPDX-License-Identifier: MIT
#include <softtissue/io/usd_text.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace softtissue;

TEST_CASE("names become identifiers, each once") {
    std::set<std::string> used{"rig"};
    CHECK(usd_identifier("skin", used) == "skin");
    CHECK(usd_identifier("mixamorig:Left Foot", used) == "mixamorig_Left_Foot");
    CHECK(usd_identifier("3rd", used) == "_3rd");
    CHECK(usd_identifier("", used) == "_");
    CHECK(usd_identifier("skin", used) == "skin_1");
    CHECK(usd_identifier("skin", used) == "skin_2");
    CHECK(usd_identifier("rig", used) == "rig_1");
    CHECK(usd_identifier("\xC3\xA4\"b", used).find_first_not_of("_b") == std::string::npos);
}

TEST_CASE("numbers come back from their shortest form") {
    std::string text;
    append_usd_tuples(text, (MatrixX<float>(2, 2) << 0.1F, -1e-20F, 1.0F / 3.0F, 1e30F).finished());
    CHECK(text == "[(0.1, 0.33333334), (-1e-20, 1e+30)]");
    text.clear();
    append_usd_tuples(text, Connectivity<4>::Constant(4, 1, 7));
    CHECK(text == "[(7, 7, 7, 7)]");
    text.clear();
    append_usd_number(text, 1.0 / 3.0);
    CHECK(std::stod(text) == 1.0 / 3.0);
}

TEST_CASE("one sample is a value, several are numbered") {
    UsdSamples samples;
    samples.add(Matrix3X<float>::Zero(3, 1));
    std::string text;
    samples.append_to(text, "point3f[] points");
    CHECK(text == "        point3f[] points = [(0, 0, 0)]\n");
    samples.add(Matrix3X<float>::Ones(3, 1));
    text.clear();
    samples.append_to(text, "point3f[] points");
    CHECK(text ==
          "        point3f[] points.timeSamples = {\n            0: [(0, 0, 0)],\n            1: [(1, 1, 1)],\n        "
          "}\n");
    CHECK(samples.size() == 2);
}
