// SPDX-License-Identifier: MIT
#include "../paper_body.hpp"

#include <examples/support/embedded_human.hpp>
#include <examples/support/layered_human.hpp>
#include <softtissue/core/byte_hash.hpp>
#include <softtissue/io/layered_body_file.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

namespace benchmarks {

using namespace softtissue;

namespace {

constexpr Index least_cells = 40000;

/// New columns in the middle of edges.
struct Halved {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    std::int32_t num_columns;
    Triangles triangles;

    explicit Halved(const LayeredBody<double>& body) : num_columns(std::int32_t(body.num_columns())) {
        const Triangles& old = body.region.triangles;
        triangles.resize(3, 4 * old.cols());
        for (Index t = 0; t < old.cols(); ++t) {
            const std::int32_t a = old(0, t), b = old(1, t), c = old(2, t);
            const std::int32_t ab = middle_of(a, b), bc = middle_of(b, c), ca = middle_of(c, a);
            triangles.middleCols<4>(4 * t) << a, ab, ca, ab,  //
                ab, b, bc, bc,                                //
                ca, bc, c, ca;
        }
    }

    std::int32_t middle_of(std::int32_t a, std::int32_t b) {
        const auto [place, is_new] = middle.try_emplace(std::minmax(a, b), num_columns + std::int32_t(edges.size()));
        if (is_new) {
            edges.push_back(std::minmax(a, b));
        }
        return place->second;
    }
};

LayeredBody<double> halved(const LayeredBody<double>& body) {
    const Halved halves(body);
    const Index old_columns = body.num_columns(), columns = old_columns + Index(halves.edges.size());
    LayeredBody<double> result;
    result.layers = {columns, 2};
    result.region.triangles = halves.triangles;
    const auto identity = [](Index size) {
        std::vector<std::int32_t> values(size_t(size), 0);
        std::iota(values.begin(), values.end(), 0);
        return values;
    };
    result.region.body_triangles = identity(halves.triangles.cols());
    result.region.body_vertices = result.region.region_vertices = identity(columns);

    std::set<std::pair<std::int32_t, std::int32_t>> rim;
    for (const std::vector<std::int32_t>& loop : body.region.loops) {
        result.region.loops.emplace_back();
        for (size_t k = 0; k < loop.size(); ++k) {
            const std::pair<std::int32_t, std::int32_t> edge = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
            rim.insert(edge);
            result.region.loops.back().push_back(loop[k]);
            result.region.loops.back().push_back(halves.middle.at(edge));
        }
    }

    Matrix3X<double>& X = result.mesh.rest_positions;
    X.resize(3, result.layers.num_vertices());
    X.leftCols(body.mesh.num_vertices()) = body.mesh.rest_positions;
    MatrixX<double> weights = MatrixX<double>::Zero(X.cols(), body.weights.num_joints());
    weights.topRows(body.mesh.num_vertices()) = body.weights.dense();
    result.skin_offsets.resize(3, columns);
    result.skin_offsets.leftCols(old_columns) = body.skin_offsets;
    result.region.cut_distance.resize(columns);
    result.region.cut_distance.head(old_columns) = body.region.cut_distance;
    result.prescribed = body.prescribed;
    for (Index c = old_columns; c < columns; ++c) {
        const auto& edge = halves.edges[size_t(c - old_columns)];
        const auto [a, b] = edge;
        const bool is_rim = rim.contains(edge);
        for (Index level = 0; level < 3; ++level) {
            const Index v = result.layers.vertex(c, level), va = body.layers.vertex(a, level),
                        vb = body.layers.vertex(b, level);
            X.col(v) = 0.5 * (X.col(va) + X.col(vb));
            weights.row(v) = 0.5 * (weights.row(va) + weights.row(vb));
            if (level == 0 || is_rim) {
                result.prescribed.push_back(std::int32_t(v));
            }
        }
        result.skin_offsets.col(c) = 0.5 * (body.skin_offsets.col(a) + body.skin_offsets.col(b));
        const double across = 0.5 * (body.mesh.rest_positions.col(body.layers.vertex(a, 2)) -
                                     body.mesh.rest_positions.col(body.layers.vertex(b, 2)))
                                        .norm();
        const double mean = 0.5 * (body.region.cut_distance(a) + body.region.cut_distance(b));
        result.region.cut_distance(c) = is_rim ? 0 : mean > 0 ? mean : across;
    }
    std::sort(result.prescribed.begin(), result.prescribed.end());
    result.weights = SkinningWeights<double>(weights);
    const Index triangles = halves.triangles.cols();
    const Connectivity<6> by_triangle = result.layers.prisms(halves.triangles);
    result.mesh.cells.resize(6, 2 * triangles);
    for (Index t = 0; t < triangles; ++t) {
        result.mesh.cells.col(t) = by_triangle.col(2 * t);
        result.mesh.cells.col(triangles + t) = by_triangle.col(2 * t + 1);
    }
    return result;
}

std::filesystem::path shared_body() {
    const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data/body/body_small.npz";
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

SkeletalLayers<double> make_paper_body(const SmplBody<double>& body) {
    SkeletalLayers<double> result;
    result.body.layered = examples::layered_body_of(body);
    do {
        result.body.layered = halved(result.body.layered);
    } while (result.body.layered.mesh.num_cells() < least_cells);
    result.body.joints = (body.joint_regressor * body.template_vertices.transpose()).transpose();
    result.tree = body.tree;
    return result;
}

}  // namespace

LayeredBody<double> subdivided(LayeredBody<double> body, int times) {
    for (int n = 0; n < times; ++n) {
        body = halved(body);
    }
    return body;
}

const PaperBody& paper_body() {
    static const PaperBody result = [] {
        const SmplBody<double> body = examples::read_human(shared_body().string());
        ByteHash hash;
        hash.add(body.template_vertices.data(), size_t(body.template_vertices.size()) * sizeof(double));
        char name[64];
        std::snprintf(name, sizeof name, "paper_body_1_%016llx.npz", static_cast<unsigned long long>(hash.value()));
        const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_BENCHMARK_FOLDER) / name;
        if (!std::filesystem::exists(path)) {
            std::filesystem::create_directories(path.parent_path());
            write_layered_body(path, make_paper_body(body));
        }
        SkeletalLayers<double> layers = read_layered_body<double>(path);
        return PaperBody{std::move(layers.body.layered), std::move(layers.body.joints), std::move(layers.tree)};
    }();
    return result;
}

}  // namespace benchmarks
