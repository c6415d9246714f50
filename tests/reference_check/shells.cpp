// SPDX-License-Identifier: MIT
// Discrete shells: dihedral angles, bending and stretching energies with both derivatives.
#include "reference_case.hpp"

#include <softtissue/energy/dihedral_difference.hpp>
#include <softtissue/energy/edge_stretch.hpp>
#include <softtissue/energy/hinge_bending.hpp>
#include <softtissue/solver/objective.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double shell_tolerance = 1e-10;

template <class Term>
void check_term(const ReferenceCase& reference, Term& term, const Matrix3X<double>& d, const std::string& prefix,
                Checklist& checks) {
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(d.cols(), {}), executor, term);
    const double energy = reference.scalar((prefix + "_energy").c_str());
    checks.add(reference.name, (prefix + " energy").c_str(), std::abs(objective.energy(d) - energy) / energy,
               shell_tolerance);
    checks.add(reference.name, (prefix + " gradient").c_str(),
               relative_difference(objective.full_gradient(d), reference.points((prefix + "_grad").c_str())),
               shell_tolerance);
    const MatrixX<double> hessian = objective.hessian(d, PsdFilter::none).matrix().toDense();
    checks.add(reference.name, (prefix + " Hessian").c_str(),
               relative_difference(hessian, reference.file.at((prefix + "_hess").c_str()).matrix<double>()),
               shell_tolerance);
}

/// The reference may run through an edge the other way: the angle does not depend on it.
double angle_error(const HingeBending<DihedralDifference<double>>& bending, const Matrix3X<double>& d,
                   const Connectivity<4>& quads, const VectorX<double>& angles) {
    std::map<std::pair<std::int32_t, std::int32_t>, Index> hinge_of;
    for (Index h = 0; h < bending.num_hinges(); ++h) {
        hinge_of[std::minmax(bending.hinges()(0, h), bending.hinges()(1, h))] = h;
    }
    double worst = bending.num_hinges() == quads.cols() ? 0.0 : 1.0;
    for (Index q = 0; q < quads.cols(); ++q) {
        const auto hinge = hinge_of.find(std::minmax(quads(0, q), quads(1, q)));
        worst = std::max(worst, hinge == hinge_of.end() ? 1.0 : std::abs(bending.angle(d, hinge->second) - angles(q)));
    }
    return worst;
}

}  // namespace

void check_shell(const ReferenceCase& reference, Checklist& checks) {
    const Matrix3X<double> X = reference.points("X");
    const Matrix3X<double> d = reference.points("x") - X;
    const TriangleMesh surface(reference.file.at("F").columns<std::int32_t, 3>(), X.cols());
    HingeBending<DihedralDifference<double>> bending(surface, X, 1.0);
    EdgeStretch<double> stretch(surface, X, 1.0);
    const Connectivity<4> quads = reference.file.at("quads").columns<std::int32_t, 4>();
    checks.add(reference.name, "angles", angle_error(bending, d, quads, reference.flat("theta")), shell_tolerance);
    checks.add(reference.name, "rest angles",
               angle_error(bending, Matrix3X<double>::Zero(3, X.cols()), quads, reference.flat("theta0")),
               shell_tolerance);
    check_term(reference, bending, d, "bend", checks);
    check_term(reference, stretch, d, "stretch", checks);
}

}  // namespace reference_check
