// SPDX-License-Identifier: MIT
// A bent limb of bone, muscle and fat by every method: what the quasi-static reference keeps and the others lose.
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/metric/gradient_error.hpp>
#include <softtissue/metric/position_error.hpp>
#include <softtissue/metric/volume_change.hpp>
#include <softtissue/ndg/layered_animation.hpp>

#include <support/catch.hpp>
#include <support/layered_limb.hpp>

#include <array>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("a bent limb by all methods", "[layered]") {
    const LayeredLimb<double> limb;
    const ThreadExecutor executor(2);
    LayeredAnimation<double, ThreadExecutor> animation(limb.body, {}, executor);
    const auto transforms = limb.transforms(1.2);
    const Matrix3X<double> skinned = limb.bent(1.2);
    std::array<Matrix3X<double>, all_animation_methods.size()> shapes;
    std::array<double, all_animation_methods.size()> volume{}, gradient{};
    for (size_t k = 0; k < all_animation_methods.size(); ++k) {
        INFO(to_string(all_animation_methods[k]));
        CHECK(animation.pose_into(all_animation_methods[k], transforms, shapes[k]).succeeded());
        for (const std::int32_t v : limb.body.prescribed) {
            CHECK(shapes[k].col(v) == skinned.col(v));
        }
        const VolumeChange<double> change = volume_change(limb.body.mesh, shapes[k]);
        volume[k] = change.mean_square;
        CHECK(change.num_inverted == 0);
        gradient[k] = gradient_error(limb.body.mesh, animation.poisson().rest(), shapes[k], shapes[0]);
        WARN(to_string(all_animation_methods[k]) << ": E_pos "
                                   << 1e3 * position_error(shapes[k], shapes[0], animation.poisson().prescribed()).mean
                                   << " mm, E_grad " << gradient[k] << ", E_vol " << volume[k]);
    }
    CHECK(shapes[1] == skinned);
    for (size_t k = 1; k < all_animation_methods.size(); ++k) {
        INFO(to_string(all_animation_methods[k]));
        CHECK(volume[0] < volume[k]);
        CHECK(gradient[k] > 0);
    }
    CHECK(gradient[3] < gradient[1]);  // Gradient Skinning before linear blending
    CHECK(volume[3] < volume[1]);

    // the equilibrium of so mild a pose does not depend on the start
    CHECK(animation.start_dependence(transforms, shapes[0]) < 1e-5);
    // the same bits on one thread
    const SequentialExecutor sequential;
    LayeredAnimation<double, SequentialExecutor> alone(limb.body, {}, sequential);
    for (size_t k = 0; k < all_animation_methods.size(); ++k) {
        Matrix3X<double> x;
        INFO(to_string(all_animation_methods[k]));
        CHECK(alone.pose_into(all_animation_methods[k], transforms, x).succeeded());
        CHECK(x == shapes[k]);
    }
}
