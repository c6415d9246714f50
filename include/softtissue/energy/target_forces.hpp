// SPDX-License-Identifier: MIT
/// @file
/// What pulls the vertices of a mesh towards target gradients, vertex by vertex.
///
/// What        half the negative gradient of sum_c V_c |F_c(x) - T_c|^2 at the free vertices
/// Equation    b_v = sum over the cells c of v of T_c (V_c g_v)  -  sum over the neighbours u of v of K_uv (x_u - x_v),
///             K = G^T W G, whose rows add up to zero: a translation of x changes rounding only
/// Shapes      targets 3 x 3 cells (T_c in columns 3c to 3c + 2); x 4 x vertices [m], the fourth number of a column finite;
///             K vertices x vertices, both triangles
/// Why         nothing is scattered: each vertex reads what it needs in one stream, and no thread waits for another
/// Cost        18 flop per free vertex and cell of it, 6 per neighbour
/// Tests       tests/unit/energy/target_forces_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>

#include <Eigen/SparseCore>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
class TargetForces {
public:
    using Scalar = S;
    using Column = Eigen::Matrix<Scalar, 4, 1>;
    using Positions = Eigen::Matrix<Scalar, 4, Eigen::Dynamic>;

    template <class ElementType>
    TargetForces(const RestOperators<ElementType, Scalar>& rest, const Connectivity<ElementType::num_nodes>& cells,
                 const Eigen::SparseMatrix<double>& K, const PrescribedVertices& prescribed) {
        constexpr int num_nodes = ElementType::num_nodes;
        checked_index(cells.cols(), "target forces: cells");
        std::vector<std::size_t> first(size_t(prescribed.num_free()) + 1, 0);
        const auto for_each_free_node = [&](const auto& f) {
            for (Index c = 0; c < cells.cols(); ++c) {
                for (int a = 0; a < num_nodes; ++a) {
                    const std::int32_t v = prescribed.free_index(cells(a, c));
                    if (v != PrescribedVertices::prescribed) {
                        f(size_t(v), c, a);
                    }
                }
            }
        };
        for_each_free_node([&](std::size_t v, Index, int) { ++first[v + 1]; });
        for (std::size_t v = 1; v < first.size(); ++v) {
            first[v] += first[v - 1];
        }
        pulls_.resize(first.back());
        ends_.resize(first.size() - 1);
        for (std::size_t v = 0; v < ends_.size(); ++v) {
            ends_[v].pulls = first[v];
        }
        for_each_free_node([&](std::size_t v, Index c, int a) {
            const Vector3<Scalar> g = rest.volumes(c) * rest.gradients.col(num_nodes * c + a);
            pulls_[ends_[v].pulls++] = {static_cast<std::int32_t>(c), {g(0), g(1), g(2)}};
        });
        for (std::size_t v = 0; v < ends_.size(); ++v) {
            const std::int32_t vertex = prescribed.free_vertices()[v];
            for (Eigen::SparseMatrix<double>::InnerIterator entry(K, vertex); entry; ++entry) {
                if (entry.row() != vertex) {
                    ties_.push_back({static_cast<std::int32_t>(entry.row()), Scalar(entry.value())});
                }
            }
            ends_[v].ties = ties_.size();
        }
    }

    /// Free vertices.
    Index size() const { return Index(ends_.size()); }
    /// What all forces together read, without targets and positions.
    Index num_bytes() const {
        return Index(pulls_.size() * sizeof(Pull) + ties_.size() * sizeof(Tie) + ends_.size() * sizeof(Ends));
    }

    /// f(v, b_v) for the free vertices from begin to end, by their number among the free ones, `vertices[v]` in the mesh; the
    /// fourth number of b_v is zero.
    template <class F>
    void for_each(Index begin, Index end, const Matrix3X<Scalar>& targets, const Positions& x,
                  const std::vector<std::int32_t>& vertices, const F& f) const {
        SOFTTISSUE_ASSERT(begin >= 0 && end <= size());
        const Pull* pull = pulls_.data() + (begin == 0 ? 0 : ends_[size_t(begin) - 1].pulls);
        const Tie* tie = ties_.data() + (begin == 0 ? 0 : ends_[size_t(begin) - 1].ties);
        for (Index v = begin; v < end; ++v) {
            // several sums, that none waits for another; four numbers at a time, none beyond the ninth of a matrix
            Column first = Column::Zero(), second = Column::Zero(), third = Column::Zero();
            for (const Pull* const last = pulls_.data() + ends_[size_t(v)].pulls; pull != last; ++pull) {
                const Scalar* const T = targets.data() + 9 * Index(pull->cell);
                first += pull->gradient[0] * column(T);
                second += pull->gradient[1] * column(T + 3);
                third += pull->gradient[2] * column(T + 5);
            }
            const Column own = x.col(vertices[size_t(v)]);
            const auto tension = [&](const Tie& of) -> Column { return of.stiffness * (x.col(of.vertex) - own); };
            const Tie* const last = ties_.data() + ends_[size_t(v)].ties;
            for (; last - tie > 1; tie += 2) {
                first -= tension(tie[0]);
                second -= tension(tie[1]);
            }
            for (; tie != last; ++tie) {
                first -= tension(*tie);
            }
            first += second;
            f(v, Column(first(0) + third(1), first(1) + third(2), first(2) + third(3), Scalar(0)));
        }
    }

private:
    struct Pull {
        std::int32_t cell;
        Scalar gradient[3];  // volume times gradient of the shape function
    };
    struct Tie {
        std::int32_t vertex;
        Scalar stiffness;
    };
    struct Ends {
        std::size_t pulls, ties;
    };

    static Eigen::Map<const Column> column(const Scalar* numbers) { return Eigen::Map<const Column>(numbers); }

    std::vector<Pull> pulls_;
    std::vector<Tie> ties_;
    std::vector<Ends> ends_;  // per free vertex
};

}  // namespace softtissue
