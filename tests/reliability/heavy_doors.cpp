// SPDX-License-Identifier: MIT
// Doors that take long to compile.
#include "doors.hpp"
#include "kinds.hpp"

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/linalg/principal_components.hpp>
#include <softtissue/mesh/harmonic.hpp>
#include <softtissue/mesh/laplacian.hpp>
#include <softtissue/mesh/winding_number.hpp>
#include <softtissue/skinning/inverse_kinematics.hpp>

#include <support/capsule_body.hpp>

#include <string>
#include <vector>

namespace reliability {

namespace {

using namespace softtissue;

void open_solvers(Ledger& ledger) {
    Doors<double> doors(ledger, "winding numbers, interpolation, inverse kinematics");
    const CapsuleBody<double> capsule;
    doors.open("vertex of a winding number", "vertex", [&](double x) {
        Matrix3X<double> positions = capsule.positions;
        positions(1, 12) = x;
        const WindingNumber<double> winding(positions, capsule.faces);
        return Doors<double>::finite(std::isfinite(winding.exact(Vector3<double>(0, 0.5, 0))));
    });
    doors.open("vertex of a Laplacian", "triangle", [&](double x) {
        Matrix3X<double> positions = capsule.positions;
        positions(1, 12) = x;
        return Doors<double>::finite(cotangent_laplacian<double>(positions, capsule.faces).toDense().allFinite());
    });
    doors.open("values to interpolate", "value", [&](double x) {
        const HarmonicInterpolation<double> harmonic(cotangent_laplacian<double>(capsule.positions, capsule.faces),
                                                     std::vector<std::int32_t>{0, 100, 200});
        return Doors<double>::finite(harmonic.interpolate(Eigen::Vector3d(1, x, 0)).allFinite());
    });
    doors.open("sample of principal components", "sample", [](double x) {
        MatrixX<double> samples(4, 3);
        samples << 1, 2, 3, 4, x, 6, 7, 8, 1, 2, 3, 5;
        return Doors<double>::finite(principal_components<double>(samples).components.allFinite());
    });
    const auto solve = [&](const PoseGoals<double>& goals, Pose<double> pose,
                           const InverseKinematicsOptions<double>& options) {
        const InverseKinematics<double> solver(capsule.tree, capsule.joints, options);
        const InverseKinematicsReport<double> report = solver.solve_into(goals, pose);
        Outcome outcome = Doors<double>::finite(pose.rotation_vectors.allFinite() && pose.translation.allFinite());
        outcome.iterations = report.iterations;
        outcome.status =
            report.status == InverseKinematicsStatus::converged ? SolveStatus::converged : SolveStatus::iteration_limit;
        return outcome;
    };
    const PoseGoals<double> goals{{{2, Vector3<double>(0.3, 0.8, 0.1), 1.0}}, {}};
    const Pose<double> rest = Pose<double>::rest(3);
    doors.open("pose that inverse kinematics start from", "joint 1", [&](double x) {
        Pose<double> pose = rest;
        pose.rotation_vectors(0, 1) = x;
        return solve(goals, pose, {});
    });
    doors.open("translation that inverse kinematics start from", "translation", [&](double x) {
        Pose<double> pose = rest;
        pose.translation(0) = x;
        return solve(goals, pose, {});
    });
    doors.open("position of a goal", "goal 0", [&](double x) {
        PoseGoals<double> far = goals;
        far.positions[0].position(2) = x;
        return solve(far, rest, {});
    });
    doors.open("weight of a goal", "goal 0", [&](double x) {
        PoseGoals<double> heavy = goals;
        heavy.positions[0].weight = x;
        return solve(heavy, rest, {});
    });
    doors.open("mobility", "mobility", [&](double x) {
        InverseKinematicsOptions<double> options;
        options.mobility = Eigen::Vector3d(1, x, 1);
        return solve(goals, rest, options);
    });
}

void open_layers(Ledger& ledger) {
    Doors<double> doors(ledger, "soft layers");
    const CapsuleBody<double> capsule;
    SoftLayerOptions<double> usual_options;
    usual_options.region.extremities = JointGroups{{0}, {2}};
    const SoftLayer<double> usual =
        make_soft_layer(capsule.positions, capsule.faces, capsule.weights, capsule.tree, capsule.joints, usual_options);
    const auto finite = [](const SoftLayer<double>& layer) {
        return Doors<double>::finite(layer.mesh.rest_positions.allFinite() && layer.thickness.allFinite());
    };
    doors.open("thickness", "thickness", [&](double x) {
        VectorX<double> thickness = usual.thickness;
        thickness(3) = x;
        return finite(with_thickness(usual, thickness));
    });
    using Options = SoftLayerOptions<double>;
    const auto option = [&](const char* name, double Options::*member) {
        doors.open(name, name, [&, member](double x) {
            Options options = usual_options;
            options.*member = x;
            return finite(make_soft_layer(capsule.positions, capsule.faces, capsule.weights, capsule.tree,
                                          capsule.joints, options));
        });
    };
    option("full_thickness", &Options::full_thickness);
    option("bone_fraction", &Options::bone_fraction);
    option("minimum_thickness", &Options::minimum_thickness);
    option("bone_radius", &Options::bone_radius);
    option("decay_distance", &Options::decay_distance);
    option("wanted_cosine", &Options::wanted_cosine);
    option("smallest_cosine", &Options::smallest_cosine);
    option("validity_margin", &Options::validity_margin);
    const auto layered = [&](const char* name, double LayeredBodyOptions<double>::*member) {
        doors.open(name, name, [member](double x) {
            LayeredBodyOptions<double> options;
            options.*member = x;
            options.validate(10);
            return Doors<double>::finite(true);
        });
    };
    layered("decay_distance", &LayeredBodyOptions<double>::decay_distance);
    layered("cut_fat", &LayeredBodyOptions<double>::cut_fat);
    layered("cut_muscle", &LayeredBodyOptions<double>::cut_muscle);
    layered("smallest_depth", &LayeredBodyOptions<double>::smallest_depth);
    layered("smallest_fat", &LayeredBodyOptions<double>::smallest_fat);
    layered("thinnest", &LayeredBodyOptions<double>::thinnest);
    layered("accepted_share", &LayeredBodyOptions<double>::accepted_share);
}

}  // namespace

void run_heavy_doors(Ledger& ledger) {
    open_solvers(ledger);
    open_layers(ledger);
}

}  // namespace reliability
