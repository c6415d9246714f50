// SPDX-License-Identifier: MIT
#include "doors.hpp"
#include "kinds.hpp"
#include "random_pose.hpp"

#include <softtissue/anatomy/make_layered_body.hpp>
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/ndg/neural_animation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace reliability {

namespace {

const SequentialExecutor executor;

struct Human {
    SmplBody<double> body = procedural_human<double>();
    SoftLayer<double> layer = make_soft_layer(body);
    CellMesh<Tet4, double> mesh = split_prisms(layer.mesh);

    FungOrthotropicField<double> field() const {
        const std::vector<Matrix3<double>> axes = orthotropy_bases<double>(mesh.cells, column_normals(layer));
        FungOrthotropicField<double>::Bases bases(9, Index(axes.size()));
        for (size_t c = 0; c < axes.size(); ++c) {
            bases.col(Index(c)) = vec<double>(axes[c]);
        }
        return FungOrthotropicField<double>({.normal_modulus = 1e4, .tangential_modulus = 4e4, .max_exponent = 12},
                                            bases);
    }
};

template <class Frame, class Policy>
void throw_human(Ledger& ledger, const Human& human, const char* what, long count, std::uint64_t seed) {
    Tally& tally = ledger.begin(std::string("embedded body, avatar, ") + what);
    tally.most_allowed_seconds = 600;
    const VolumetricSmpl<double, Policy> tissue =
        make_tissue_model(VolumetricSmpl<double, Policy>(human.body), human.layer);
    SoftTissueAvatar<Tet4, FungOrthotropicField<double>, Frame, Policy> avatar(
        tissue, human.mesh, human.layer.prescribed_vertices, human.field(), executor);
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        const Index joints = human.body.num_joints();
        const Pose<double> pose = random_pose<double>(joints, random), other = random_pose<double>(joints, random);
        avatar.start(pose);
        tally.attempt([&] {
            Outcome outcome =
                outcome_of(avatar.step(between(pose, other, random.uniform(0, 0.02))), avatar.positions());
            outcome.is_finite =
                outcome.is_finite && avatar.velocities().allFinite() && avatar.displacement().allFinite();
            return outcome;
        });
    }
    ledger.print_last();
}

/// Layers of tissue in bodies of shapes to four deviations, all coefficients at once.
void shape_human(Ledger& ledger, const Human& human, long count, std::uint64_t seed) {
    VolumetricSmpl<double> model(human.body);
    const auto random_shape = [&](long k) {
        RandomGenerator random(seed + std::uint64_t(k));
        VectorX<double> betas(model.num_shapes());
        const double size = k % 2 == 0 ? 4 : 2;
        for (double& beta : betas) {
            beta = random.uniform(-size, size);
        }
        return betas;
    };
    Tally& soft = ledger.begin("embedded body, shapes to 4 deviations, soft layer");
    for (long k = 0; k < count; ++k) {
        const VectorX<double> betas = random_shape(k);
        soft.attempt([&] {
            const SoftLayer<double> layer = make_soft_layer(model.rest_shape(betas), human.body.faces,
                                                            human.body.weights, human.body.tree, model.joints(betas));
            if (layer.mesh.count_inverted(layer.mesh.rest_positions) > 0) {
                soft.fail("inverted cells at rest");
            }
            return Doors<double>::finite(layer.mesh.rest_positions.allFinite());
        });
    }
    ledger.print_last();
    Tally& layered = ledger.begin("embedded body, shapes to 4 deviations, layered body");
    for (long k = 0; k < (count + 9) / 10; ++k) {
        const VectorX<double> betas = random_shape(k);
        layered.attempt([&] {
            const LayeredBody<double> layers = make_layered_body(
                model.rest_shape(betas), human.body.faces, human.body.weights, human.body.tree, model.joints(betas));
            if (layers.mesh.count_inverted(layers.mesh.rest_positions) > 0) {
                layered.fail("inverted cells at rest");
            }
            return Doors<double>::finite(layers.mesh.rest_positions.allFinite());
        });
    }
    ledger.print_last();
}

/// A network of random weights on the layered body.
void animate_human(Ledger& ledger, const Human& human, long count, std::uint64_t seed) {
    const VolumetricSmpl<double> model(human.body);
    const LayeredBody<double> layers = make_layered_body(human.body.template_vertices, human.body.faces,
                                                         human.body.weights, human.body.tree, model.rest_joints());
    PoissonReconstruction<Prism6, double> poisson(layers.mesh,
                                                  PrescribedVertices(layers.mesh.num_vertices(), layers.prescribed));
    Tally& tally = ledger.begin("embedded body, network of random weights, Poisson");
    Mlp<float> mlp(
        {.inputs = num_pose_features(human.body.tree), .hidden = {32, 16}, .outputs = 9 * layers.mesh.num_cells()});
    mlp.initialize(seed, 0.3F);
    const NeuralModel<float> neural{"random",
                                    {.shape_input = false},
                                    mlp,
                                    ShapeSpace<double>(),
                                    body_identity(layers, human.body.tree, human.body.joint_names),
                                    {}};
    NeuralAnimation<double, SequentialExecutor> animation(neural, layers, human.body.tree, human.body.joint_names,
                                                          poisson, executor);
    Matrix3X<double> x;
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        const Pose<double> pose = random_pose<double>(human.body.num_joints(), random);
        const std::vector<AffineTransform<double>> transforms =
            joint_transforms(human.body.tree, model.rest_joints(), pose);
        tally.attempt([&] {
            animation.pose_into(pose, transforms, x);
            return Doors<double>::finite(x.allFinite());
        });
    }
    ledger.print_last();
}

}  // namespace

void run_embedded(Ledger& ledger, long count, std::uint64_t seed) {
    if (count == 0) {
        return;
    }
    const Human human;
    animate_human(ledger, human, count, seed);
    shape_human(ledger, human, (count + 9) / 10, seed);
    throw_human<UnposedFrame, LinearBlend<double>>(ledger, human, "unposed, linear blend", count, seed);
    throw_human<RestRetargetedFrame, DualQuaternion<double>>(ledger, human, "retargeted, dual quaternions", count,
                                                             seed);
}

}  // namespace reliability
