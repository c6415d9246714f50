// SPDX-License-Identifier: MIT
/// @file
/// The Delaunay tetrahedralisation of points in space.
///
/// What        tets that fill the convex hull of the points, no point inside the sphere through the corners of a tet.
/// Shapes      points 3 x n on the grid of grid_predicates.hpp; tets 4 x m, positive in the grid.
/// Valid       any points that are not all on one plane: symmetric, regular, many on one plane or one sphere. The decisions are
///             exact, so the tets neither overlap nor leave a gap between the grid points, flat ones do not occur.
/// Refuses     fewer than four points, all on one plane, two points at one place of the grid (InvalidInput names them)
/// Source      incremental insertion of Bowyer 1981 and Watson 1981, the outside filled by tets with a vertex at infinity.
/// Cost        O(n log n) for points as they come on surfaces; 0.1 s for 4,000. The same bits at every call.
/// Tests       tests/unit/mesh/delaunay_tetrahedra_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/mesh/grid_predicates.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

class DelaunayBuilder {
public:
    explicit DelaunayBuilder(const Matrix3X<double>& points) : points_(points) {
        require(points.cols() >= 4, "Delaunay: ", points.cols(), " points, expected at least 4");
        make_first_tet();
        for (const std::int32_t p : insertion_order()) {
            insert(p);
        }
    }

    Connectivity<4> tets() const {
        std::vector<Corners> finite;
        for (const Cell& cell : cells_) {
            if (!cell.is_erased && infinite_corner(cell) < 0) {
                finite.push_back(cell.corners);
            }
        }
        Connectivity<4> result(4, static_cast<Index>(finite.size()));
        for (size_t c = 0; c < finite.size(); ++c) {
            result.col(static_cast<Index>(c)) << finite[c][0], finite[c][1], finite[c][2], finite[c][3];
        }
        return result;
    }

private:
    static constexpr std::int32_t infinity = -1;
    using Corners = std::array<std::int32_t, 4>;

    /// neighbours[k] shares the face opposite to corners[k]. A cell at infinity is positive for any point beyond its face.
    struct Cell {
        Corners corners;
        std::array<std::int32_t, 4> neighbours;
        std::int32_t tested_for = -1;  // the last point tested
        bool in_conflict = false;
        bool is_erased = false;
    };

    struct OpenFace {
        std::array<std::int32_t, 2> edge;  // the two corners besides the new point and `corner`
        std::int32_t cell;
        int corner;
    };

    Vector3<double> point(std::int32_t v) const { return points_.col(v); }

    static int infinite_corner(const Cell& cell) {
        const auto found = std::find(cell.corners.begin(), cell.corners.end(), infinity);
        return found == cell.corners.end() ? -1 : static_cast<int>(found - cell.corners.begin());
    }

    /// The sign of the cell with `p` in place of its corner k.
    int orientation_with(const Cell& cell, int k, std::int32_t p) const {
        Corners v = cell.corners;
        v[size_t(k)] = p;
        return orientation(point(v[0]), point(v[1]), point(v[2]), point(v[3]));
    }

    bool is_inside_sphere(const Cell& cell, std::int32_t p) const {
        const Corners& v = cell.corners;
        return sphere_side(point(v[0]), point(v[1]), point(v[2]), point(v[3]), point(p)) > 0;
    }

    bool conflicts(const Cell& cell, std::int32_t p) const {
        const int k = infinite_corner(cell);
        if (k < 0) {
            return is_inside_sphere(cell, p);
        }
        const int side = orientation_with(cell, k, p);
        // In the plane of a face, the circle around the face is cut from the sphere of the tet behind it.
        return side > 0 || (side == 0 && is_inside_sphere(cells_[size_t(cell.neighbours[size_t(k)])], p));
    }

    void make_first_tet() {
        // Far apart, so that rounding does not choose points on a line or plane unless all are.
        const auto farthest = [this](const auto& measure) {
            std::int32_t best = 0;
            for (std::int32_t v = 1; v < points_.cols(); ++v) {
                best = measure(point(v)) > measure(point(best)) ? v : best;
            }
            return best;
        };
        const Vector3<double> a = point(0);
        const std::int32_t b = farthest([&](const Vector3<double>& x) { return (x - a).norm(); });
        const Vector3<double> ab = point(b) - a;
        const std::int32_t c = farthest([&](const Vector3<double>& x) { return ab.cross(x - a).norm(); });
        const Vector3<double> normal = ab.cross(point(c) - a);
        const std::int32_t d = farthest([&](const Vector3<double>& x) { return std::abs(normal.dot(x - a)); });
        first_ = {0, b, c, d};
        const int side = orientation(a, point(b), point(c), point(d));
        require(side != 0, "Delaunay: all points lie on one plane, expected a volume");
        if (side < 0) {
            std::swap(first_[0], first_[1]);
        }
        cells_.push_back({first_, {1, 2, 3, 4}});
        for (std::int32_t k = 0; k < 4; ++k) {
            // Infinity lies beyond the face; two of its corners change places to turn it.
            Corners corners = first_;
            corners[size_t(k)] = infinity;
            std::array<std::int32_t, 4> neighbours{1, 2, 3, 4};
            neighbours[size_t(k)] = 0;
            const size_t i = size_t(k + 1) % 4;
            const size_t j = size_t(k + 2) % 4;
            std::swap(corners[i], corners[j]);
            std::swap(neighbours[i], neighbours[j]);
            cells_.push_back({corners, neighbours});
        }
    }

    /// All other points, shuffled: an order along the surface would make large cavities.
    std::vector<std::int32_t> insertion_order() const {
        std::vector<std::int32_t> order;
        for (std::int32_t v = 0; v < points_.cols(); ++v) {
            if (std::find(first_.begin(), first_.end(), v) == first_.end()) {
                order.push_back(v);
            }
        }
        std::uint64_t state = 1;
        for (size_t i = order.size(); i > 1; --i) {
            state = state * 6364136223846793005U + 1442695040888963407U;
            std::swap(order[i - 1], order[size_t(state >> 33U) % i]);
        }
        return order;
    }

    /// A cell in conflict with p, reached by crossing faces that have p beyond them.
    std::int32_t locate(std::int32_t p) const {
        std::int32_t current = last_;
        for (bool is_moving = true; is_moving;) {
            is_moving = false;
            const Cell& cell = cells_[size_t(current)];
            for (int k = 0; k < 4 && !is_moving; ++k) {
                if (orientation_with(cell, k, p) < 0) {
                    current = cell.neighbours[size_t(k)];
                    is_moving = infinite_corner(cells_[size_t(current)]) < 0;
                    if (!is_moving) {
                        return current;
                    }
                }
            }
        }
        for (const std::int32_t v : cells_[size_t(current)].corners) {
            require(point(v) != point(p), "Delaunay: points ", std::min(v, p), " and ", std::max(v, p),
                    " lie at the same place, expected distinct points");
        }
        return current;
    }

    bool is_in_conflict(std::int32_t c, std::int32_t p) {
        Cell& cell = cells_[size_t(c)];
        if (cell.tested_for != p) {
            cell.tested_for = p;
            cell.in_conflict = conflicts(cell, p);
        }
        return cell.in_conflict;
    }

    /// Replaces the cells in conflict with p by the cone from p over their common boundary.
    void insert(std::int32_t p) {
        std::vector<std::int32_t> cavity{locate(p)};
        cells_[size_t(cavity.front())].tested_for = p;
        cells_[size_t(cavity.front())].in_conflict = true;
        cells_[size_t(cavity.front())].is_erased = true;
        std::vector<OpenFace> open;
        for (size_t i = 0; i < cavity.size(); ++i) {
            for (int k = 0; k < 4; ++k) {
                const std::int32_t c = cavity[i];
                const std::int32_t n = cells_[size_t(c)].neighbours[size_t(k)];
                if (!is_in_conflict(n, p)) {
                    add_cell(c, k, p, open);
                } else if (!cells_[size_t(n)].is_erased) {
                    cells_[size_t(n)].is_erased = true;
                    cavity.push_back(n);
                }
            }
        }
        join(open);
    }

    /// The cell of p and the face opposite to corner k of the cavity's cell c.
    void add_cell(std::int32_t c, int k, std::int32_t p, std::vector<OpenFace>& open) {
        const std::int32_t added = checked_index(Index(cells_.size()), "Delaunay tets: cells, erased ones included");
        Cell cell = cells_[size_t(c)];
        cell.corners[size_t(k)] = p;
        cell.is_erased = false;
        cell.in_conflict = false;
        Cell& outside = cells_[size_t(cell.neighbours[size_t(k)])];
        *std::find(outside.neighbours.begin(), outside.neighbours.end(), c) = added;
        for (int j = 0; j < 4; ++j) {
            if (j != k) {
                std::array<std::int32_t, 2> edge{};
                size_t size = 0;
                for (int i = 0; i < 4; ++i) {
                    if (i != j && i != k) {
                        edge[size++] = cell.corners[size_t(i)];
                    }
                }
                open.push_back({{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}, added, j});
            }
        }
        cells_.push_back(cell);
        if (infinite_corner(cell) < 0) {
            last_ = added;
        }
    }

    /// New cells that share an edge of the cavity's boundary are neighbours.
    void join(std::vector<OpenFace>& open) {
        std::sort(open.begin(), open.end(), [](const OpenFace& a, const OpenFace& b) { return a.edge < b.edge; });
        for (size_t i = 0; i < open.size(); i += 2) {
            cells_[size_t(open[i].cell)].neighbours[size_t(open[i].corner)] = open[i + 1].cell;
            cells_[size_t(open[i + 1].cell)].neighbours[size_t(open[i + 1].corner)] = open[i].cell;
        }
    }

    const Matrix3X<double>& points_;
    std::vector<Cell> cells_;
    Corners first_{};
    std::int32_t last_ = 0;  // a cell without infinity, where the next search starts
};

}  // namespace detail

/// Tets on the given grid points (to_grid()).
inline Connectivity<4> delaunay_tetrahedra(const Matrix3X<double>& grid_points) {
    return detail::DelaunayBuilder(grid_points).tets();
}

}  // namespace softtissue
