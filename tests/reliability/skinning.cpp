// SPDX-License-Identifier: MIT
#include "kinds.hpp"
#include "random_pose.hpp"

#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <cmath>
#include <string>

namespace reliability {

namespace {

template <class S, class Policy>
void pose_human(Ledger& ledger, const SmplBody<S>& body, const char* what, bool is_rigid, long count,
                std::uint64_t seed) {
    Tally& tally = ledger.begin(std::string("embedded body, ") + what);
    VolumetricSmpl<S, Policy> model(body);
    PosedBody<S> posed;
    const SequentialExecutor executor;
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        const bool new_shape = k % 10 == 0;
        if (new_shape) {
            // all coefficients at once, each within four deviations
            VectorX<S> betas(model.num_shapes());
            for (S& beta : betas) {
                beta = S(random.uniform(-4, 4));
            }
            model.set_shape(betas);
        }
        const Pose<S> pose = random_pose<S>(model.num_joints(), random);
        tally.attempt([&] {
            model.pose_into(pose, posed, executor);
            Outcome outcome;
            outcome.is_finite = posed.positions.allFinite() && posed.offsets.allFinite();
            // whatever the pose, a body of some two metres does not leave the ball of ten around its translation
            const double reach = double((posed.positions.colwise() - pose.translation).colwise().norm().maxCoeff());
            if (!(reach < 10)) {
                tally.fail("a vertex is " + std::to_string(reach) + " m from the body");
            }
            for (size_t v = 0; is_rigid && v < posed.transforms.size(); v += 97) {
                if (!is_rotation<S>(posed.transforms[v].linear, S(1e-4))) {
                    tally.fail("the transform of vertex " + std::to_string(v) + " is no rotation");
                }
            }
            return outcome;
        });
    }
    ledger.print_last();
}

}  // namespace

void run_skinning(Ledger& ledger, long count, std::uint64_t seed) {
    const SmplBody<double> body = procedural_human<double>();
    const SmplBody<float> small = body.cast<float>();
    pose_human<double, LinearBlend<double>>(ledger, body, "linear blend, shapes to 4 deviations", false, count, seed);
    pose_human<double, DualQuaternion<double>>(ledger, body, "dual quaternions, shapes to 4 deviations", true, count,
                                               seed);
    pose_human<float, LinearBlend<float>>(ledger, small, "linear blend, float", false, count, seed);
    pose_human<float, DualQuaternion<float>>(ledger, small, "dual quaternions, float", true, count, seed);
}

}  // namespace reliability
