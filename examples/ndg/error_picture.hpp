// SPDX-License-Identifier: MIT
/// @file
/// Where on the body methods are wrong: mean error of every column of vertices, from the front and from the back, on one
/// scale for all methods (as Nolte et al. 2026, fig. 7).
#pragma once

#include "../support/color_scale.hpp"
#include "../support/mesh_picture.hpp"

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace examples {

/// The skin to draw on; where no layers are, it stays neutral.
struct ErrorSurface {
    Matrix3X<double> positions;
    softtissue::Triangles triangles;
    std::vector<std::int32_t> column_vertices;  // of the surface, one per column
};

/// One method's part of the picture.
struct ErrorMap {
    std::string name;
    double mean = 0.0;              // E_pos [m]
    Eigen::VectorXd column_errors;  // [m]
};

/// The surface of the layers themselves, without what is not simulated.
inline ErrorSurface layered_surface(const softtissue::LayeredBody<double>& body) {
    ErrorSurface surface{body.level_positions(2) + body.skin_offsets, body.region.triangles, {}};
    for (Index c = 0; c < body.num_columns(); ++c) {
        surface.column_vertices.push_back(static_cast<std::int32_t>(c));
    }
    return surface;
}

/// A whole skin around them; throws unless it is that of the body.
inline ErrorSurface whole_surface(const softtissue::LayeredBody<double>& body,
                                  const softtissue::SmplBody<double>& whole) {
    const std::vector<std::int32_t>& vertices = body.region.body_vertices;
    const Matrix3X<double> columns = layered_surface(body).positions;
    for (size_t c = 0; c < vertices.size(); ++c) {
        softtissue::require(vertices[c] < whole.num_vertices() &&
                                (whole.template_vertices.col(vertices[c]) - columns.col(Index(c))).norm() < 1e-6,
                            "body to draw: its vertex ", vertices[c], " is not that of the data set");
    }
    return {whole.template_vertices, whole.faces, vertices};
}

/// The end of the scale: above 99 % of all columns of all methods, on a round number of millimetres.
inline double error_scale(const std::vector<ErrorMap>& maps) {
    std::vector<double> all;
    for (const ErrorMap& map : maps) {
        all.insert(all.end(), map.column_errors.begin(), map.column_errors.end());
    }
    const auto place = all.begin() + std::ptrdiff_t(0.99 * double(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    const double millimetres = std::max(0.1, 1e3 * *place);
    const double power = std::pow(10.0, std::floor(std::log10(millimetres)));
    for (const double lead : {1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
        if (lead * power >= millimetres) {
            return 1e-3 * lead * power;
        }
    }
    return 1e-2 * power;
}

inline void write_error_maps(const std::filesystem::path& path, const ErrorSurface& surface,
                             const std::vector<ErrorMap>& maps, const std::string& title) {
    constexpr int width = 300, top = 96, margin = 24;
    const int panel = 2 * width + margin;
    const Eigen::Vector3d center =
        0.5 * (surface.positions.rowwise().minCoeff() + surface.positions.rowwise().maxCoeff());
    const Eigen::Vector3d size = surface.positions.rowwise().maxCoeff() - surface.positions.rowwise().minCoeff();
    const double scale = 0.96 * std::min(width / size.x(), 700.0 / size.y());
    const int height = int(scale * size.y() / 0.96);
    Picture picture(std::max(900, margin + panel * int(maps.size())), top + height + 92);
    picture.text(title, margin, 40, 22);
    const double end = error_scale(maps);
    for (size_t k = 0; k < maps.size(); ++k) {
        const int x = margin + panel * int(k);
        char caption[96];
        std::snprintf(caption, sizeof caption, "%s, E_pos %.2f mm", maps[k].name.c_str(), 1e3 * maps[k].mean);
        picture.text(caption, x + width, 80, 18, 0.5);
        Matrix3X<float> colors = scale_color(0.0).replicate(1, surface.positions.cols());
        for (size_t c = 0; c < surface.column_vertices.size(); ++c) {
            colors.col(surface.column_vertices[c]) = scale_color(maps[k].column_errors(Index(c)) / end);
        }
        for (int side = 0; side < 2; ++side) {
            const View view(side * 2.0 * std::acos(0.0), 0.0);
            picture.mesh(surface.positions, surface.triangles, colors, view, center, scale, x + side * width, top,
                         width, height);
        }
    }
    const int bar = top + height + 28;
    constexpr int steps = 400;
    for (int k = 0; k < steps; ++k) {
        picture.rectangle(margin + k, bar, 1, 16, scale_color((k + 0.5) / steps));
    }
    for (int k = 0; k <= 4; ++k) {
        char label[32];
        std::snprintf(label, sizeof label, "%.3g%s", 250.0 * k * end, k == 4 ? " mm" : "");
        picture.text(label, margin + k * steps / 4, bar + 36, 15, k == 0 ? 0.0 : k == 4 ? 0.3 : 0.5);
    }
    picture.text("mean distance of skin and muscle vertex to the reference", margin + steps + 24, bar + 14, 15);
    picture.write(path);
}

}  // namespace examples
