// SPDX-License-Identifier: MIT
// Elements proven through static solves: patch test, zero-energy modes, node orders, order of convergence.
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <Eigen/Eigenvalues>
#include <support/catch.hpp>
#include <support/patch_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Law = StableNeoHookean<double>;
using Field = UniformField<Law>;
const Law law = Law::from_young_poisson({1e4, 0.4});

template <class ElementType>
MatrixX<double> rest_stiffness(const CellMesh<ElementType, double>& mesh, const std::vector<std::int32_t>& held) {
    ElasticEnergy<ElementType, Field> elastic(mesh, Field{law});
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(mesh.num_vertices(), held), executor, elastic);
    return objective.hessian(Matrix3X<double>::Zero(3, mesh.num_vertices()), PsdFilter::none).matrix().toDense();
}

struct Modes {
    int zero = 0;
    double smallest = 0;  ///< the smallest other eigenvalue, relative to the largest
};

Modes modes(const MatrixX<double>& stiffness) {
    const VectorX<double> values =
        Eigen::SelfAdjointEigenSolver<MatrixX<double>>(stiffness, Eigen::EigenvaluesOnly).eigenvalues();
    const double largest = values(values.size() - 1);
    Modes result;
    while (result.zero < values.size() && std::abs(values(result.zero)) < 1e-12 * largest) {
        ++result.zero;
    }
    result.smallest = values(result.zero) / largest;
    return result;
}

template <class ElementType>
CellMesh<ElementType, double> one_cell() {
    const auto block = solid_block<ElementType>({.n = 1});
    CellMesh<ElementType, double> mesh{block.mesh.rest_nodes(0), Connectivity<ElementType::num_nodes>(ElementType::num_nodes, 1)};
    std::iota(mesh.cells.data(), mesh.cells.data() + ElementType::num_nodes, 0);
    return mesh;
}

/// Energies of the one cell under all orders of its nodes that the mesh accepts.
template <class ElementType>
std::vector<double> energies_of_accepted_orders() {
    const CellMesh<ElementType, double> mesh = one_cell<ElementType>();
    RandomGenerator random(3);
    const Matrix3X<double> d = random_displacement<double>(ElementType::num_nodes, 0.1, random);
    std::array<std::int32_t, ElementType::num_nodes> order;
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> energies;
    do {
        CellMesh<ElementType, double> permuted = mesh;
        std::copy(order.begin(), order.end(), permuted.cells.data());
        try {
            permuted.validate();
        } catch (const InvalidInput& error) {
            const std::string text = error.what();
            REQUIRE(text.find("cell 0 has a rest Jacobian bound of ") != std::string::npos);
            REQUIRE_THROWS_AS((ElasticEnergy<ElementType, Field>(permuted, Field{law})), InvalidInput);
            continue;
        }
        ElasticEnergy<ElementType, Field> elastic(permuted, Field{law});
        energies.push_back(elastic.energy(d, SequentialExecutor{}));
    } while (std::next_permutation(order.begin(), order.end()));
    return energies;
}

/// u_k = a_k sin(w_k . X + b_k), and the body force that holds it.
struct Manufactured {
    Matrix3<double> w;  // w_k in row k
    Vector3<double> a{0.06, -0.05, 0.07};
    Vector3<double> b{0.3, 1.1, -0.4};

    Manufactured() { w << 2.0, 1.0, -1.5, -1.0, 2.5, 1.0, 1.5, -0.5, 2.0; }

    Vector3<double> displacement(const Vector3<double>& X) const {
        const Vector3<double> phase = w * X + b;
        return a.cwiseProduct(Vector3<double>(phase.array().sin()));
    }

    /// -div P
    Vector3<double> body_force(const Vector3<double>& X) const {
        const Vector3<double> phase = w * X + b;
        const Vector3<double> first = a.cwiseProduct(Vector3<double>(phase.array().cos()));
        const Vector3<double> second = -a.cwiseProduct(Vector3<double>(phase.array().sin()));
        const Matrix3<double> F = Matrix3<double>::Identity() + first.asDiagonal() * w;
        const Matrix9<double> H = law.hessian(F);
        Vector3<double> force = Vector3<double>::Zero();
        for (int J = 0; J < 3; ++J) {
            for (int L = 0; L < 3; ++L) {
                for (int k = 0; k < 3; ++k) {
                    force -= H.block<3, 1>(3 * J, 3 * L + k) * second(k) * w(k, L) * w(k, J);
                }
            }
        }
        return force;
    }
};

/// Calls f(natural coordinates, weight [m^3]); exact for quadratic integrands, times the Jacobian for prisms.
template <class F>
void integrate(Tet4, const NodePositions<Tet4, double>& X, const F& f) {
    const double a = (5 - std::sqrt(5.0)) / 20, b = 1 - 3 * a;
    for (const Vector3<double>& xi : {Vector3<double>(a, a, a), Vector3<double>(b, a, a), Vector3<double>(a, b, a),
                                      Vector3<double>(a, a, b)}) {
        f(xi, Tet4::rest_volume(X) / 4);
    }
}
template <class F>
void integrate(Prism6, const NodePositions<Prism6, double>& X, const F& f) {
    const Matrix3<double> jacobians = Prism6::bernstein_jacobians(X);
    for (const double zeta : {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}) {
        const double s = (1 + zeta) / 2, gauss = zeta == 0.0 ? 4.0 / 9 : 5.0 / 18;
        const Vector3<double> bernstein((1 - s) * (1 - s), 2 * s * (1 - s), s * s);
        for (int i = 0; i < 3; ++i) {
            Vector3<double> lambda = Vector3<double>::Constant(1.0 / 6);
            lambda(i) = 2.0 / 3;
            f(Vector3<double>(lambda(1), lambda(2), zeta), gauss / 6 * bernstein.dot(jacobians * lambda));
        }
    }
}

/// The loads that keep the manufactured displacement in equilibrium, tested with the shape functions.
class BodyForce {
public:
    using Scalar = double;
    explicit BodyForce(Matrix3X<double> loads) : loads_(std::move(loads)) {}
    double energy(const Matrix3X<double>& d, const SequentialExecutor&) const { return -loads_.cwiseProduct(d).sum(); }
    void add_gradient(const Matrix3X<double>&, Matrix3X<double>& gradient, const SequentialExecutor&) const {
        gradient -= loads_;
    }
    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&) const {}
    void bind(const PrescribedVertices&, const BlockPattern&) {}
    void add_hessian(const Matrix3X<double>&, PsdFilter, BlockMatrix<double>&, const SequentialExecutor&) const {}

private:
    Matrix3X<double> loads_;
};

/// L2 norm of the error of the displacement over the unit cube [m^(5/2)].
template <class ElementType>
double displacement_error(const BlockOptions& options) {
    const Manufactured exact;
    const auto block = solid_block<ElementType>(options);
    const auto& mesh = block.mesh;
    Matrix3X<double> loads = Matrix3X<double>::Zero(3, mesh.num_vertices());
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<ElementType, double> X = mesh.rest_nodes(c);
        integrate(ElementType{}, X, [&](const Vector3<double>& xi, double weight) {
            const NodeValues<ElementType, double> N = ElementType::shape_values(xi);
            const Vector3<double> force = exact.body_force(ElementType::position(X, xi));
            for (int i = 0; i < ElementType::num_nodes; ++i) {
                loads.col(mesh.cells(i, c)) += weight * N(i) * force;
            }
        });
    }
    Matrix3X<double> d = Matrix3X<double>::Zero(3, mesh.num_vertices());
    for (const std::int32_t v : block.surface) {
        d.col(v) = exact.displacement(mesh.rest_positions.col(v));
    }
    ElasticEnergy<ElementType, Field> elastic(mesh, Field{law});
    BodyForce body_force(loads);
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(mesh.num_vertices(), block.surface), executor, elastic, body_force);
    DirectSolver<double> linear_solver;
    REQUIRE(minimise(objective, linear_solver, d).succeeded());
    double square = 0;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<ElementType, double> X = mesh.rest_nodes(c), moved = mesh.gather(d, mesh.cells.col(c));
        integrate(ElementType{}, X, [&](const Vector3<double>& xi, double weight) {
            const Vector3<double> error =
                moved * ElementType::shape_values(xi) - exact.displacement(ElementType::position(X, xi));
            square += weight * error.squaredNorm();
        });
    }
    return std::sqrt(square);
}

struct Orders {
    double coarse;
    double fine;
};

template <class ElementType>
Orders convergence(const char* what, BlockOptions options) {
    std::array<double, 3> errors{};
    for (size_t k = 0; k < 3; ++k) {
        options.n = 2 << k;
        errors[k] = displacement_error<ElementType>(options);
    }
    const Orders orders{std::log2(errors[0] / errors[1]), std::log2(errors[1] / errors[2])};
    WARN(what << ": L2 errors " << errors[0] << ", " << errors[1] << ", " << errors[2] << "; orders " << orders.coarse
              << ", " << orders.fine);
    return orders;
}

}  // namespace

TEST_CASE("patch test of tets in any disorder", "[element]") {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const PatchResult result = patch_test<Tet4>({.n = 4, .noise = 0.12, .seed = seed}, Field{law});
        CHECK(result.succeeded);
        CHECK(result.num_inner == 27);
        CHECK(result.strain_error < 1e-12);
        CHECK(result.error < 1e-12);
    }
}

TEST_CASE("patch test of sheared prisms", "[element]") {
    // triangles in any disorder; every level slid sideways and to another height
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const PatchResult result = patch_test<Prism6>({.n = 4, .plan_noise = 0.1, .level_noise = 0.2, .seed = seed}, Field{law});
        CHECK(result.succeeded);
        CHECK(result.num_inner == 27);
        CHECK(result.strain_error < 1e-12);
        CHECK(result.error < 1e-12);
    }
}

TEST_CASE("prisms whose triangles are not parallel copies reproduce affine strain, not affine equilibrium", "[element]") {
    // the gradient is that of a best fit, and not the volume average that integration by parts asks for
    double last = 0;
    for (const double noise : {0.02, 0.04, 0.08}) {
        const PatchResult result = patch_test<Prism6>({.n = 4, .noise = noise}, Field{law});
        WARN("noise of " << noise << " edges: inner vertices off by " << result.error / 0.25 << " edges");
        CHECK(result.succeeded);
        CHECK(result.strain_error < 1e-12);
        CHECK(result.error > last);
        CHECK(result.error < 0.25 * noise);  // an edge is 0.25 m: off by less than the vertices were moved
        last = result.error;
    }
}

TEST_CASE("modes without energy", "[element]") {
    SECTION("a free tet, and any free mesh of tets: the six rigid ones") {
        CHECK(modes(rest_stiffness(one_cell<Tet4>(), {})).zero == 6);
        CHECK(modes(rest_stiffness(solid_block<Tet4>({.n = 2, .noise = 0.1}).mesh, {})).zero == 6);
    }
    SECTION("a free prism: six rigid and six hourglass modes") {
        CHECK(modes(rest_stiffness(one_cell<Prism6>(), {})).zero == 12);
    }
    SECTION("layers of prisms with one face prescribed: none") {
        for (const int layers : {1, 2, 3}) {
            const auto block = solid_block<Prism6>({.n = 3, .layers = layers, .plan_noise = 0.05, .noise = 0.05});
            const Modes held = modes(rest_stiffness(block.mesh, block.bottom));
            const Modes free = modes(rest_stiffness(block.mesh, {}));
            WARN(layers << " layers: " << free.zero << " zero modes free, " << held.zero
                   << " held; smallest eigenvalue held " << held.smallest << " of the largest");
            CHECK(held.zero == 0);
            CHECK(held.smallest > 1e-4);
        }
    }
    SECTION("a face prescribed is not enough for a prism or two on their own") {
        // the free triangle of a prism can turn; so can the two of a pair, about the edge between them
        CHECK(modes(rest_stiffness(one_cell<Prism6>(), {0, 1, 2})).zero == 3);
        const auto pair = solid_block<Prism6>({.n = 1});
        CHECK(modes(rest_stiffness(pair.mesh, pair.bottom)).zero == 1);
    }
}

TEST_CASE("the energy does not see the order of the nodes; wrong orders are refused", "[element]") {
    const auto check = [](const std::vector<double>& energies, size_t expected) {
        REQUIRE(energies.size() == expected);
        for (const double energy : energies) {
            CHECK(std::abs(energy / energies.front() - 1) < 1e-13);
        }
    };
    check(energies_of_accepted_orders<Tet4>(), Tet4::symmetries.size());
    check(energies_of_accepted_orders<Prism6>(), Prism6::symmetries.size());
}

TEST_CASE("order of convergence to a manufactured solution", "[element]") {
    const Orders tets = convergence<Tet4>("tets in disorder", {.noise = 0.08});
    CHECK(tets.fine > 1.85);
    CHECK(tets.fine < 2.3);
    const Orders prisms = convergence<Prism6>("sheared prisms", {.plan_noise = 0.08, .level_noise = 0.1});
    CHECK(prisms.fine > 1.85);
    CHECK(prisms.fine < 2.3);
    const Orders warped = convergence<Prism6>("smoothly warped prisms", {.warp = 0.05});
    CHECK(warped.fine > 1.85);
    CHECK(warped.fine < 2.3);
    // a disorder that does not fade with the edge length: the error of the patch test stays
    const Orders disorder = convergence<Prism6>("prisms in disorder", {.noise = 0.05});
    CHECK(disorder.coarse > 1);
    CHECK(disorder.fine < 1);
}
