// SPDX-License-Identifier: MIT
#include "doors.hpp"
#include "kinds.hpp"

#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/resample.hpp>

#include <support/capsule_body.hpp>

#include <string>
#include <vector>

namespace reliability {

namespace {

using namespace softtissue;

const Matrix3<double> stretched = (Matrix3<double>() << 1.1, 0.2, 0, -0.1, 0.9, 0.1, 0, 0.3, 1.2).finished();

template <class Law>
Outcome evaluated(const Law& law) {
    const Matrix3<typename Law::Scalar> F = stretched.cast<typename Law::Scalar>();
    return Doors<double>::finite(std::isfinite(law.energy_density(F)) && law.first_piola(F).allFinite());
}

template <class S>
void open_materials(Ledger& ledger, const char* what) {
    Doors<S> doors(ledger, std::string("laws, ") + what);
    using Fung = FungOrthotropicParameters<S>;
    const auto fung = [&](const char* name, S Fung::*member) {
        doors.open(name, name, [member](S x) {
            Fung parameters{.normal_modulus = S(1e4), .tangential_modulus = S(2e4)};
            parameters.*member = x;
            // a huge modulus has a huge energy, which may leave the range of the numbers: what counts is what is accepted
            return Doors<S>::finite(FungOrthotropic<S>(parameters, Matrix3<S>::Identity()).basis().allFinite());
        });
    };
    fung("normal_modulus", &Fung::normal_modulus);
    fung("tangential_modulus", &Fung::tangential_modulus);
    fung("poisson_ratio", &Fung::poisson_ratio);
    fung("exponent", &Fung::exponent);
    fung("max_exponent", &Fung::max_exponent);
    doors.open("axes", "basis", [](S x) {
        Matrix3<S> axes = Matrix3<S>::Identity();
        axes(1, 2) = x;
        return evaluated(FungOrthotropic<S>({.normal_modulus = S(1e4), .tangential_modulus = S(2e4)}, axes));
    });
    doors.open("mu", "mu", [](S x) {
        return Doors<S>::finite(StableNeoHookean<S>({x, S(1e4)}).parameters().lambda > 0);
    });
    doors.open("lambda", "lambda", [](S x) {
        return Doors<S>::finite(StableNeoHookean<S>({S(1e4), x}).parameters().mu > 0);
    });
    doors.open("Young's modulus", "young_modulus", [](S x) {
        return Doors<S>::finite(std::isfinite(lame_parameters<S>({x, S(0.4)}).lambda));
    });
    doors.open("Poisson's ratio", "poisson_ratio", [](S x) {
        return Doors<S>::finite(std::isfinite(lame_parameters<S>({S(1e4), x}).lambda));
    });
    doors.open("stiffness", "stiffness", [](S x) { return Doors<S>::finite(Arap<S>({x}).parameters().stiffness > 0); });
    doors.open("lambda, polar", "lambda", [](S x) {
        return Doors<S>::finite(CorotatedLinearPolar<S>({S(1e4), x}).parameters().mu > 0);
    });
}

void open_meshes(Ledger& ledger) {
    Doors<double> doors(ledger, "surfaces, weights, skeletons, motions");
    const CapsuleBody<double> capsule;
    doors.open("skinning weight", "weights[7, 1]", [&](double x) {
        MatrixX<double> dense = capsule.weights.dense();
        dense(7, 1) = x;
        return Doors<double>::finite(SkinningWeights<double>(dense).dense().allFinite());
    });
    doors.open("vertex of a surface", "vertex 12", [&](double x) {
        Matrix3X<double> positions = capsule.positions;
        positions(1, 12) = x;
        validate_closed_surface(positions, capsule.faces, "surface");
        return Doors<double>::finite(true);
    });
    const Pose<double> rest = Pose<double>::rest(3);
    Motion<double> motion{{rest, rest, rest}, 30.0};
    const auto resampled = [](const Motion<double>& from, double rate) {
        const Motion<double> result = resample(from, rate);
        return Doors<double>::finite(result.poses.back().rotation_vectors.allFinite() &&
                                     result.poses.back().translation.allFinite());
    };
    doors.open("rotation in a motion", "frame 1, joint 2", [&](double x) {
        Motion<double> spoilt = motion;
        spoilt.poses[1].rotation_vectors(0, 2) = x;
        return resampled(spoilt, 60);
    });
    doors.open("translation in a motion", "frame 1", [&](double x) {
        Motion<double> spoilt = motion;
        spoilt.poses[1].translation(0) = x;
        return resampled(spoilt, 60);
    });
    doors.open("frame rate", "frame rate", [&](double x) {
        Motion<double> spoilt = motion;
        spoilt.frame_rate = x;
        return resampled(spoilt, 60);
    });
    doors.open("new frame rate", "frame rate", [&](double x) { return resampled(motion, x); });
}

}  // namespace

void run_doors(Ledger& ledger) {
    open_materials<double>(ledger, "double");
    open_materials<float>(ledger, "float");
    open_meshes(ledger);
}

}  // namespace reliability
