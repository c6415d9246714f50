// SPDX-License-Identifier: MIT
#include <softtissue/energy/concepts.hpp>

#include <softtissue/element/tet4.hpp>
#include <softtissue/energy/dead_load.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/inertia.hpp>
#include <softtissue/energy/strain_frame.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/field.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// A term of a user: one spring to the origin at every vertex.
template <class S>
struct Anchors {
    using Scalar = S;
    S stiffness = S(2);
    std::vector<std::int32_t> free;

    template <Executor E>
    S energy(const Matrix3X<S>& d, const E&) {
        return S(0.5) * stiffness * d.squaredNorm();
    }
    template <Executor E>
    void add_gradient(const Matrix3X<S>& d, Matrix3X<S>& gradient, const E&) {
        gradient += stiffness * d;
    }
    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&) {}
    void bind(const PrescribedVertices& prescribed, const BlockPattern&) { free = prescribed.free_vertices(); }
    template <Executor E>
    void add_hessian(const Matrix3X<S>&, PsdFilter, BlockMatrix<S>& hessian, const E&) {
        for (Index j = 0; j < Index(free.size()); ++j) {
            hessian.add(j, 0, stiffness * Matrix3<S>::Identity());
        }
    }
};

struct NoHessian {
    using Scalar = double;
    double energy(const Matrix3X<double>&, const SequentialExecutor&);
    void add_gradient(const Matrix3X<double>&, Matrix3X<double>&, const SequentialExecutor&);
    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&);
    void bind(const PrescribedVertices&, const BlockPattern&);
};
struct EnergyInAnotherScalar : Anchors<double> {
    float energy(const Matrix3X<double>&, const SequentialExecutor&);
};

using Elastic = ElasticEnergy<Tet4, UniformField<Arap<double>>>;

struct FrameWithoutApply {
    static constexpr bool is_unposed = true;
};

}  // namespace

static_assert(EnergyTerm<Anchors<double>>);
static_assert(EnergyTerm<Anchors<float>>);
static_assert(EnergyTerm<Elastic>);
static_assert(EnergyTerm<Inertia<double>>);
static_assert(EnergyTerm<DeadLoad<float>>);
static_assert(!EnergyTerm<NoHessian>);
static_assert(!EnergyTerm<EnergyInAnotherScalar>);
static_assert(StrainFrame<UnposedFrame, Elastic>);
static_assert(StrainFrame<WorldFrame, Elastic>);
static_assert(StrainFrame<RestRetargetedFrame, Elastic>);
static_assert(!StrainFrame<FrameWithoutApply, Elastic>);

TEST_CASE("a term may offer more than the concept asks") {
    Anchors<double> anchors;
    BlockMatrix<double> hessian{BlockPattern(std::vector<std::vector<std::int32_t>>(1))};
    anchors.bind(PrescribedVertices(1, {}), hessian.pattern());
    anchors.add_hessian(Matrix3X<double>::Zero(3, 1), PsdFilter::none, hessian, SequentialExecutor{});
    CHECK(hessian.matrix().toDense() == 2 * Matrix3<double>::Identity());
}
