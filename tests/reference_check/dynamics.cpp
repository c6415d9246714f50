// SPDX-License-Identifier: MIT
// Implicit Euler trajectories with a moving prescribed boundary.
#include "cell_materials.hpp"
#include "reference_case.hpp"

#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/implicit_euler.hpp>

#include <algorithm>

namespace reference_check {
namespace {

using namespace softtissue;

constexpr double trajectory_tolerance = 1e-6;

/// Row `n` of an (S + 1, k, 3) array, 3 x k.
Matrix3X<double> time_slice(const VectorX<double>& values, Index n, Index count) {
    return Eigen::Map<const Matrix3X<double>>(values.data() + 3 * count * n, 3, count);
}

template <class Field>
void check_trajectory(const ReferenceCase& reference, Field field, Checklist& checks) {
    const Matrix3X<double> X = reference.points("X");
    const CellMesh<Tet4, double> mesh{X, reference.file.at("T").columns<std::int32_t, 4>()};
    ElasticEnergy<Tet4, Field> elastic(mesh, std::move(field));
    const VectorX<double> masses = lumped_masses(mesh, reference.scalar("rho"));
    checks.add(reference.name, "lumped masses", relative_difference(masses, reference.file.at("mass").vector<double>()), 1e-12);

    const VectorX<std::int32_t> fixed = reference.file.at("fixed").vector<std::int32_t>();
    const VectorX<double> x_fixed = reference.flat("x_fixed");
    const VectorX<double> x = reference.flat("x");
    const SequentialExecutor executor;
    DirectSolver<double> linear_solver;
    ImplicitEuler euler(masses, reference.scalar("dt"), PrescribedVertices(X.cols(), {fixed.data(), size_t(fixed.size())}), X,
                        linear_solver, executor, elastic);
    euler.set_acceleration(reference.file.at("gravity").vector<double>());
    euler.placement().origins = X;

    Matrix3X<double> d = Matrix3X<double>::Zero(3, X.cols());
    const Index num_steps = x.size() / (3 * X.cols()) - 1;
    double worst = 0.0;
    Index failed = 0;
    int most_iterations = 0;
    for (Index n = 1; n <= num_steps; ++n) {
        const Matrix3X<double> boundary = time_slice(x_fixed, n, fixed.size());
        for (Index i = 0; i < fixed.size(); ++i) {
            d.col(fixed(i)) = boundary.col(i) - X.col(fixed(i));
        }
        const SolveReport<double> report = euler.step(d);
        failed += report.succeeded() ? 0 : 1;
        most_iterations = std::max(most_iterations, report.iterations);
        worst = std::max(worst, (euler.state().positions - time_slice(x, n, X.cols())).colwise().norm().maxCoeff());
    }
    checks.add(reference.name, "trajectory / box", worst / box_size(X), trajectory_tolerance);
    checks.add(reference.name, "steps not converged", double(failed), 0.0);
    std::printf("%-28s %d steps, at most %d Newton iterations\n", reference.name.c_str(), int(num_steps), most_iterations);
}

}  // namespace

void check_dynamics(const ReferenceCase& reference, Checklist& checks) {
    const Index num_cells = reference.file.at("T").shape()[0];
    if (reference.has("eta")) {
        check_trajectory(reference, fung_orthotropic_field(reference, num_cells), checks);
    } else {
        check_trajectory(reference, stable_neo_hookean_field(reference, num_cells), checks);
    }
}

}  // namespace reference_check
