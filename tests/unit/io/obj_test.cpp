// SPDX-License-Identifier: MIT
#include <softtissue/io/obj.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace softtissue;
using namespace io_test;

namespace {

template <RealScalar S = double>
ObjMesh<S> read(const std::string& text) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.obj", text);
    return read_obj<S>(folder / "a.obj");
}

std::string refused(const std::string& text) {
    return refusal([&] { static_cast<void>(read(text)); });
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE_TEMPLATE("positions and faces are read, the rest is skipped", S, float, double) {
    const ObjMesh<S> mesh = read<S>(
        "# a comment\nmtllib a.mtl\no thing\n\nv 0 0 0 # inline\r\nv  1.5\t-2e-1 .25 0.5 0.5 0.5\n"
        "v 0 1 0\nvt 0 0\nvn 0 0 1\ng part\nusemtl red\ns 1\nf 1/1/1 2//1 3/1\nl 1 2\n");
    CHECK(mesh.positions.cols() == 3);
    CHECK(mesh.positions.col(1) == Vector3<S>(S(1.5), S(-0.2), S(0.25)));
    CHECK(mesh.triangles == Triangles(Eigen::Vector3i(0, 1, 2)));
}

TEST_CASE("polygons become fans, negative indices count backwards") {
    CHECK(read(square + "f 1 2 3 4\n").triangles == (Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished());
    CHECK(read(square + "f -4 -3 -1").triangles == Triangles(Eigen::Vector3i(0, 1, 3)));
}

TEST_CASE_TEMPLATE("what is written is read again, to the last bit", S, float, double) {
    const TemporaryFolder folder;
    const Matrix3X<S> positions =
        (Matrix3X<S>(3, 3) << S(1) / S(3), S(-1e-30), 0, S(2e20), 1, S(0.1), 5, S(-7.25), 3).finished();
    const Triangles triangles(Eigen::Vector3i(2, 0, 1));
    write_obj(folder / "a.obj", positions, triangles);
    const ObjMesh<S> mesh = read_obj<S>(folder / "a.obj");
    CHECK(mesh.positions == positions);
    CHECK(mesh.triangles == triangles);
    CHECK(folder.num_files() == 1);
}

TEST_CASE("what cannot be read is refused with its line") {
    CHECK(contains(refused("v abc 1 2\n"), "a.obj: line 1 is 'v abc 1 2', expected three finite coordinates"));
    CHECK(contains(refused("v 1 2\n"), "expected three finite coordinates"));
    CHECK(contains(refused("v 1 2 3x\n"), "expected three finite coordinates"));
    CHECK(contains(refused("v nan 1 2\n"), "expected three finite coordinates"));
    CHECK(contains(refused("v 1e999 1 2\n"), "expected three finite coordinates"));
    for (const char* face :
         {"f 1 2 5", "f 0 1 2", "f 1 2 -5", "f a b c", "f 1 2 3.5", "f 1 2 99999999999999999999", "f 1 2 /3"}) {
        CAPTURE(face);
        CHECK(contains(refused(square + face),
                       std::string("a.obj: line 5 is '") + face + "', expected a face of vertices"));
    }
    CHECK(contains(refused(square + "f 1 2"), "line 5 is 'f 1 2', expected a face of at least three vertices"));
    CHECK(contains(refused(square), "a.obj: no faces"));
    const TemporaryFolder folder;
    write_bytes(folder / "b.obj", "v 0 0 0\nv 1 0 0\nv 0 1e39 0\nf 1 2 3");
    CHECK(contains(refusal([&] { static_cast<void>(read_obj<float>(folder / "b.obj")); }),
                   "b.obj: vertex 3 is too large for 32 bits"));
    CHECK(contains(refused(""), "a.obj: no faces"));
    CHECK(
        contains(refusal([] { static_cast<void>(read_obj<double>("/none/a.obj")); }), "/none/a.obj: cannot be opened"));
    CHECK(contains(refusal([] { static_cast<void>(read_obj<double>("/")); }), "/: cannot be opened"));
}
