// SPDX-License-Identifier: MIT
#include "doors.hpp"
#include "kinds.hpp"
#include "random_pose.hpp"

#include <softtissue/ndg/layered_animation.hpp>
#include <softtissue/ndg/neural_animation.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <support/limb_model.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace reliability {

namespace {

using namespace softtissue_test;
using Transforms = std::vector<AffineTransform<double>>;

const SequentialExecutor executor;

struct Limb {
    LayeredLimb<double> limb;
    KinematicTree tree = two_joint_tree();
    Matrix3X<double> joints = Matrix3X<double>::Zero(3, 2);
    LayeredAnimation<double, SequentialExecutor> animation{limb.body, {}, executor};

    Limb() { joints(0, 0) = -0.2; }

    Transforms transforms(const Pose<double>& pose) const { return joint_transforms<double>(tree, joints, pose); }
};

void pose_layers(Ledger& ledger, Limb& limb, long count, std::uint64_t seed) {
    for (const AnimationMethod method : all_animation_methods) {
        Tally& tally = ledger.begin(std::string("layered limb by ") + to_string(method));
        tally.rest_tolerance = 1e-6;
        tally.must_recover = true;
        Matrix3X<double> x;
        for (long k = 0; k < count; ++k) {
            RandomGenerator random(seed + std::uint64_t(k));
            const Transforms transforms = limb.transforms(random_pose<double>(2, random));
            tally.attempt([&] {
                Outcome outcome = outcome_of(limb.animation.pose_into(method, transforms, x), x);
                if (method == AnimationMethod::fem) {
                    // The first bone goes home with all flesh, the other at once from where it is then.
                    const double size = 0.4;
                    const Matrix3X<double>& rest = limb.limb.body.mesh.rest_positions;
                    const AffineTransform<double> home = transforms[0].inverse();
                    Matrix3X<double> back = x;
                    for (Index v = 0; v < back.cols(); ++v) {
                        back.col(v) = home(x.col(v));
                    }
                    double jump = 0;
                    for (const std::int32_t v : limb.limb.body.prescribed) {
                        jump = std::max(jump, (back.col(v) - rest.col(v)).norm());
                        back.col(v) = rest.col(v);
                    }
                    const SolveReport<double> report =
                        limb.animation.flesh().solve_into(back, {.max_iterations = 200, .linear_tolerance = 1e-6});
                    outcome.has_rest = report.succeeded();
                    // Half a turn of a bone about itself winds the flesh up as much as one across moves it.
                    const double cosine = ((home * transforms[1]).linear.trace() - 1) / 2;
                    outcome.may_stay = !(jump < size / 2 && cosine > 0);
                    outcome.distance = (back - rest).colwise().norm().maxCoeff() / size;
                    outcome.is_finite = outcome.is_finite && back.allFinite();
                }
                return outcome;
            });
        }
        ledger.print_last();
    }
}

void pose_networks(Ledger& ledger, Limb& limb, long count, std::uint64_t seed) {
    Tally& tally = ledger.begin("layered limb by networks of random weights");
    Matrix3X<double> x;
    const std::vector<double> scales{0, 0.1, 1, 10, 1e3};
    for (size_t m = 0; m < 2 * scales.size(); ++m) {
        const NetworkOptions options{.exponential = m % 2 == 0, .rotation = m % 4 < 2};
        const NeuralModel<float> model = random_limb_model<float>(options, scales[m / 2], seed + m);
        NeuralAnimation<double, SequentialExecutor> animation(model, limb.limb.body, limb.tree, two_joint_names(),
                                                              limb.animation.poisson(), executor);
        for (long k = 0; k < count / long(2 * scales.size()) + 1; ++k) {
            RandomGenerator random(seed + std::uint64_t(k));
            const Pose<double> pose = random_pose<double>(2, random);
            const Transforms transforms = limb.transforms(pose);
            tally.attempt([&] {
                animation.pose_into(pose, transforms, x);
                return Doors<double>::finite(x.allFinite());
            });
        }
    }
    ledger.print_last();
}

/// Shapes to four deviations, along all components at once.
void shape_limbs(Ledger& ledger, long count, std::uint64_t seed) {
    Tally& tally = ledger.begin("shape space of limbs, 4 deviations, and back");
    const ShapeSpace<double> space = limb_shapes();
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        VectorX<double> coefficients(space.num_coefficients());
        for (double& c : coefficients) {
            c = random.uniform(-4, 4);
        }
        tally.attempt([&] {
            const Matrix3X<double> body = space.decode(coefficients);
            Outcome outcome = Doors<double>::finite(body.allFinite());
            if (!((space.encode(body) - coefficients).cwiseAbs().maxCoeff() < 1e-8)) {
                tally.fail("the coefficients do not come back");
            }
            return outcome;
        });
    }
    ledger.print_last();
}

void open_doors(Ledger& ledger, Limb& limb) {
    const LayeredBody<double>& body = limb.limb.body;
    const Matrix3X<double>& rest = body.mesh.rest_positions;
    const Pose<double> still = Pose<double>::rest(2);
    PoissonReconstruction<Prism6, double>& poisson = limb.animation.poisson();
    const std::int32_t free = poisson.prescribed().free_vertices()[7], held = body.prescribed[5];
    Doors<double> doors(ledger, "layered bodies, networks");
    for (const AnimationMethod method : all_animation_methods) {
        doors.open(std::string("rotation of a joint, ") + to_string(method), "joint 1", [&](double bad) {
            Transforms transforms = limb.transforms(still);
            transforms[1].linear(0, 2) = bad;
            Matrix3X<double> x;
            return outcome_of(limb.animation.pose_into(method, transforms, x), x);
        });
        doors.open(std::string("translation of a joint, ") + to_string(method), "joint 1", [&](double bad) {
            Transforms transforms = limb.transforms(still);
            transforms[1].translation(0) = bad;
            Matrix3X<double> x;
            return outcome_of(limb.animation.pose_into(method, transforms, x), x);
        });
    }
    for (const std::int32_t v : {free, held}) {
        doors.open("position that flesh starts from", "position", [&](double bad) {
            Matrix3X<double> x = rest;
            x(1, v) = bad;
            return outcome_of(limb.animation.flesh().solve_into(x), x);
        });
        doors.open("position that local and global steps start from", "position", [&](double bad) {
            LocalGlobal<Prism6, double> solver(poisson);
            Matrix3X<double> x = rest;
            x(1, v) = bad;
            return outcome_of(solver.solve_into(x), x);
        });
        doors.open("position of a Poisson reconstruction", "vertex " + std::to_string(v), [&](double bad) {
            Matrix3X<double> x = rest, targets = Matrix3<double>::Identity().replicate(1, poisson.num_cells());
            x(2, v) = bad;
            poisson.solve_into(targets, x);
            return Doors<double>::finite(x.allFinite());
        });
    }
    doors.open("target gradient", "cell 11", [&](double bad) {
        Matrix3X<double> x = rest, targets = Matrix3<double>::Identity().replicate(1, poisson.num_cells());
        targets(2, 3 * 11 + 1) = bad;
        poisson.solve_into(targets, x);
        return Doors<double>::finite(x.allFinite());
    });
    doors.open("rotation of a cell, co-rotated", "cell 3", [&](double bad) {
        CorotatedLinearSolver<Prism6, double, SequentialExecutor> solver(body.mesh, poisson.prescribed(),
                                                                         layer_moduli<double>(body, {}), executor);
        std::vector<Matrix3<double>> rotations(size_t(body.mesh.num_cells()), Matrix3<double>::Identity());
        rotations[3](0, 0) = bad;
        Matrix3X<double> x = rest;
        Outcome outcome = Doors<double>::finite(true);
        outcome.status = solver.solve_into(rotations, x) ? SolveStatus::converged : SolveStatus::linear_solver_failed;
        outcome.is_finite = x.allFinite();
        return outcome;
    });
    const auto flesh = [&](const char* name, const char* word, double FleshParameters<double>::*member) {
        doors.open(name, word, [&rest, &body, member](double bad) {
            FleshParameters<double> parameters;
            parameters.*member = bad;
            LayeredFlesh<double, SequentialExecutor> solver(body, parameters, executor);
            Matrix3X<double> x = rest;
            return outcome_of(solver.solve_into(x), x);
        });
    };
    flesh("stretching", "stiffness", &FleshParameters<double>::stretch);
    flesh("bending", "stiffness", &FleshParameters<double>::bending);
    doors.open("modulus of muscle", "young_modulus", [&](double bad) {
        LayeredFlesh<double, SequentialExecutor> solver(body, {.muscle = {bad, 0.4}}, executor);
        Matrix3X<double> x = rest;
        return outcome_of(solver.solve_into(x), x);
    });
    const auto animate = [&](const NeuralModel<float>& model, const Pose<double>& pose, const Transforms& transforms) {
        NeuralAnimation<double, SequentialExecutor> animation(model, body, limb.tree, two_joint_names(), poisson,
                                                              executor);
        Matrix3X<double> x;
        animation.pose_into(pose, transforms, x);
        return Doors<double>::finite(x.allFinite());
    };
    const NeuralModel<float> model = random_limb_model<float>({}, 0.1);
    doors.open("rotation of a pose, network", "joint 1", [&](double bad) {
        Pose<double> pose = still;
        pose.rotation_vectors(1, 1) = bad;
        return animate(model, pose, limb.transforms(still));
    });
    doors.open("transform of a joint, network", "joint 0", [&](double bad) {
        Transforms transforms = limb.transforms(still);
        transforms[0].linear(1, 1) = bad;
        return animate(model, still, transforms);
    });
    doors.open("weight of a network", "weight", [&](double bad) {
        NeuralModel<float> spoilt = model;
        spoilt.mlp.parameters()(20) = float(bad);
        return animate(spoilt, still, limb.transforms(still));
    });
    const ShapeSpace<double> space = limb_shapes();
    doors.open("shape coefficient", "coefficient 1",
               [&](double bad) { return Doors<double>::finite(space.decode(Eigen::Vector2d(1, bad)).allFinite()); });
    doors.open("shape to encode", "vertex 9", [&](double bad) {
        Matrix3X<double> x = rest;
        x(0, 9) = bad;
        return Doors<double>::finite(space.encode(x).allFinite());
    });
}

}  // namespace

void run_layers(Ledger& ledger, long count, std::uint64_t seed) {
    Limb limb;
    open_doors(ledger, limb);
    pose_layers(ledger, limb, count, seed);
    pose_networks(ledger, limb, count, seed);
    shape_limbs(ledger, count, seed);
}

}  // namespace reliability
