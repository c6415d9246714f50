// SPDX-License-Identifier: MIT
// Static equilibria under prescribed faces and dead loads, tets and prisms, and the assembly at a random state.
#include "cell_materials.hpp"
#include "reference_case.hpp"

#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/dead_load.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/solver/continuation.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/objective.hpp>

namespace reference_check {
namespace {

using namespace softtissue;

// Energies, forces and products with stiffness at a random state far from equilibrium: sums of exact cell values.
constexpr double assembly_tolerance = 1e-11;
constexpr double equilibrium_tolerance = 1e-7;

template <class ElementType, class Field>
void check_assembly(const ReferenceCase& reference, ElasticEnergy<ElementType, Field>& elastic, const Matrix3X<double>& X,
                    Checklist& checks) {
    const SequentialExecutor executor;
    const Matrix3X<double> d = reference.points("x_test") - X;
    Objective objective(PrescribedVertices(X.cols(), {}), executor, elastic);
    const double energy = reference.scalar("energy_test");
    checks.add(reference.name, "energy at a random state", std::abs(objective.energy(d) - energy) / std::abs(energy),
               assembly_tolerance);
    checks.add(reference.name, "forces at a random state",
               relative_difference(objective.full_gradient(d), reference.points("grad_test")), assembly_tolerance);
    const Matrix3X<double> direction = reference.points("dir_test");
    const Matrix3X<double> expected = reference.points("Hd_test");
    VectorX<double> product;
    objective.hessian(d, PsdFilter::none)
        .multiply_into(VectorX<double>(direction.reshaped()), product, executor);
    checks.add(reference.name, "stiffness times a direction",
               relative_difference(product, VectorX<double>(expected.reshaped())), assembly_tolerance);
}

template <class ElementType, class Field>
void check_static(const ReferenceCase& reference, const Connectivity<ElementType::num_nodes>& cells, Field field,
                  Checklist& checks) {
    const Matrix3X<double> X = reference.points("X");
    ElasticEnergy<ElementType, Field> elastic(CellMesh<ElementType, double>{X, cells}, std::move(field));
    check_assembly(reference, elastic, X, checks);

    DeadLoad<double> load(reference.points("f_ext"));
    const SequentialExecutor executor;
    const VectorX<std::int32_t> fixed = reference.file.at("fixed").vector<std::int32_t>();
    const Matrix3X<double> x_fixed = reference.points("x_fixed");
    Matrix3X<double> d = Matrix3X<double>::Zero(3, X.cols());
    Matrix3X<double> target = d;
    for (Index i = 0; i < fixed.size(); ++i) {
        target.col(fixed(i)) = x_fixed.col(i) - X.col(fixed(i));
    }
    Objective objective(PrescribedVertices(X.cols(), {fixed.data(), size_t(fixed.size())}), executor, elastic, load);
    DirectSolver<double> linear_solver;
    const SolveReport<double> report = follow_boundary(objective, linear_solver, d, target);
    const Matrix3X<double> x = X + d;
    checks.add(reference.name, report.succeeded() ? "equilibrium / box" : to_string(report.status),
               report.succeeded() ? (x - reference.points("x")).colwise().norm().maxCoeff() / box_size(X) : 1.0,
               equilibrium_tolerance);
    const double energy = reference.scalar("energy");
    checks.add(reference.name, "elastic energy", std::abs(elastic.energy(d, executor) - energy) / std::abs(energy), 1e-9);
    std::printf("%-28s %d Newton iterations, %d of them filtered\n", reference.name.c_str(), report.iterations,
                report.filtered_iterations);
}

template <class ElementType>
void check_static(const ReferenceCase& reference, const char* cells_name, Checklist& checks) {
    const Connectivity<ElementType::num_nodes> cells =
        reference.file.at(cells_name).columns<std::int32_t, ElementType::num_nodes>();
    if (reference.has("eta")) {
        check_static<ElementType>(reference, cells, fung_orthotropic_field(reference, cells.cols()), checks);
    } else {
        check_static<ElementType>(reference, cells, stable_neo_hookean_field(reference, cells.cols()), checks);
    }
}

}  // namespace

void check_static_tets(const ReferenceCase& reference, Checklist& checks) { check_static<Tet4>(reference, "T", checks); }
void check_static_prisms(const ReferenceCase& reference, Checklist& checks) { check_static<Prism6>(reference, "C", checks); }

}  // namespace reference_check
