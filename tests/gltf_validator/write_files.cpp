// SPDX-License-Identifier: MIT
// Writes the kinds of file that GltfAnimation can make, for the validator.
#include <softtissue/io/gltf.hpp>

#include <cmath>
#include <filesystem>

using namespace softtissue;

namespace {

const Triangles tetrahedron = (Triangles(3, 4) << 0, 0, 1, 0, 2, 1, 2, 3, 1, 3, 3, 2).finished();

Matrix3X<double> frame(int t) {
    Matrix3X<double> x = (Matrix3X<double>(3, 4) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1).finished();
    return (1.0 + 0.1 * std::sin(double(t))) * x;
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    GltfAnimation animation(30.0);
    const Matrix3X<float> colors = Matrix3X<float>::Constant(3, 4, 0.25F);
    const Index smooth = animation.add_mesh({.name = "smooth", .triangles = tetrahedron, .colors = colors});
    const Index flat = animation.add_mesh({.name = "flat \"ä\"",
                                           .triangles = tetrahedron,
                                           .translation = {2, 0, 0},
                                           .smooth_shading = false,
                                           .opacity = 0.5});
    const Index still = animation.add_mesh({.name = "still", .triangles = tetrahedron, .translation = {4, 0, 0}});
    animation.add_frame(still, frame(0));
    for (int t = 0; t < 7; ++t) {
        animation.add_frame(smooth, frame(t));
        animation.add_frame(flat, frame(2 * t));
    }
    animation.write(folder / "animated.glb");

    GltfAnimation picture(24.0);
    picture.add_frame(picture.add_mesh({.name = "m", .triangles = tetrahedron}), Matrix3X<double>::Zero(3, 4));
    picture.write(folder / "still.glb");
}
