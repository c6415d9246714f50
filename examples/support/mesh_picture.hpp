// SPDX-License-Identifier: MIT
/// @file
/// A picture of triangle meshes: depth buffer, soft light from the front, text and boxes by cairo, written as PNG.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <cairo/cairo.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace examples {

using softtissue::Index;
using softtissue::Matrix3X;

/// Orthographic view: turned about y by `yaw`, then tilted; the picture plane is x right, y up, in metres.
struct View {
    Eigen::Matrix3d rotation;
    View(double yaw, double pitch)
        : rotation(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY())) {}
};

class Picture {
public:
    Picture(int width, int height)
        : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
          cairo_(cairo_create(surface_.get())) {
        cairo_set_source_rgb(cairo_.get(), 1.0, 1.0, 1.0);
        cairo_paint(cairo_.get());
    }

    /// The drawing context for lines and plots, in pixels.
    cairo_t* context() { return cairo_.get(); }

    /// `align`: 0 left, 0.5 centred, 1 right at x; y is the baseline.
    void text(const std::string& words, double x, double y, double size, double align = 0.0) {
        cairo_move_to(cairo_.get(), x - align * text_width(words, size), y);
        cairo_set_source_rgb(cairo_.get(), 0.15, 0.15, 0.15);
        cairo_show_text(cairo_.get(), words.c_str());
    }

    double text_width(const std::string& words, double size) {
        select_font(size);
        cairo_text_extents_t extents;
        cairo_text_extents(cairo_.get(), words.c_str(), &extents);
        return extents.x_advance;
    }

    void rectangle(double x, double y, double width, double height, const Eigen::Vector3f& color) {
        cairo_set_source_rgb(cairo_.get(), double(color(0)), double(color(1)), double(color(2)));
        cairo_rectangle(cairo_.get(), x, y, width, height);
        cairo_fill(cairo_.get());
    }

    /// Draws a mesh into the box (x, y, width, height) with `center` of the world in its middle, `scale` pixels a metre.
    /// `colors`: sRGB per vertex, 3 x n; `opacity` mixes the mesh with what was drawn before.
    void mesh(const Matrix3X<double>& positions, const softtissue::Triangles& triangles, const Matrix3X<float>& colors,
              const View& view, const Eigen::Vector3d& center, double scale, int x, int y, int width, int height,
              float opacity = 1.0F) {
        constexpr int samples = 3;  // along each side of a pixel
        Raster raster(samples * width, samples * height);
        Matrix3X<double> screen = view.rotation * (positions.colwise() - center);
        screen.topRows<2>() *= scale * samples;
        screen.row(0).array() += 0.5 * samples * width;
        screen.row(1) = (0.5 * samples * height - screen.row(1).array()).matrix().eval();
        const Matrix3X<double> normals = view.rotation * softtissue::vertex_normals(positions, triangles);
        Matrix3X<float> shaded = colors;
        for (Index v = 0; v < positions.cols(); ++v) {
            const Eigen::Vector3d light = Eigen::Vector3d(-0.4, 0.5, 0.77).normalized();
            const double lit = std::max(0.0, normals.col(v).dot(light));
            shaded.col(v) *= float(0.42 + 0.62 * lit);
        }
        for (Index t = 0; t < triangles.cols(); ++t) {
            raster.triangle(screen, shaded, triangles.col(t));
        }
        copy(raster, samples, x, y, width, height, opacity);
    }

    void write(const std::filesystem::path& path) {
        cairo_surface_flush(surface_.get());
        softtissue::AtomicFile file(path);
        const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), file.temporary_path().c_str());
        file.require_written(status != CAIRO_STATUS_WRITE_ERROR);
        softtissue::require(status == CAIRO_STATUS_SUCCESS, path.string(),
                            ": cannot write: ", cairo_status_to_string(status));
        file.commit();
    }

private:
    void select_font(double size) {
        cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(cairo_.get(), size);
    }

    struct Raster {
        int width, height;
        std::vector<double> depth;
        std::vector<Eigen::Vector3f> color;

        Raster(int w, int h)
            : width(w),
              height(h),
              depth(size_t(w) * size_t(h), -std::numeric_limits<double>::infinity()),
              color(depth.size(), Eigen::Vector3f::Ones()) {}

        void triangle(const Matrix3X<double>& screen, const Matrix3X<float>& shaded, const Eigen::Vector3i& corners) {
            const Eigen::Vector3d a = screen.col(corners(0)), b = screen.col(corners(1)), c = screen.col(corners(2));
            const double area = (b(0) - a(0)) * (c(1) - a(1)) - (b(1) - a(1)) * (c(0) - a(0));
            if (area == 0.0) {
                return;
            }
            const int left = std::max(0, int(std::floor(std::min({a(0), b(0), c(0)}))));
            const int right = std::min(width - 1, int(std::ceil(std::max({a(0), b(0), c(0)}))));
            const int top = std::max(0, int(std::floor(std::min({a(1), b(1), c(1)}))));
            const int bottom = std::min(height - 1, int(std::ceil(std::max({a(1), b(1), c(1)}))));
            for (int row = top; row <= bottom; ++row) {
                for (int column = left; column <= right; ++column) {
                    const double px = column + 0.5, py = row + 0.5;
                    const double wa = ((b(0) - px) * (c(1) - py) - (b(1) - py) * (c(0) - px)) / area;
                    const double wb = ((c(0) - px) * (a(1) - py) - (c(1) - py) * (a(0) - px)) / area;
                    const double wc = 1.0 - wa - wb;
                    const double z = wa * a(2) + wb * b(2) + wc * c(2);
                    const size_t place = size_t(row) * size_t(width) + size_t(column);
                    if (wa >= 0.0 && wb >= 0.0 && wc >= 0.0 && z > depth[place]) {
                        depth[place] = z;
                        color[place] = float(wa) * shaded.col(corners(0)) + float(wb) * shaded.col(corners(1)) +
                                       float(wc) * shaded.col(corners(2));
                    }
                }
            }
        }
    };

    struct SurfaceDestroy {
        void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    };
    struct ContextDestroy {
        void operator()(cairo_t* context) const { cairo_destroy(context); }
    };

    /// Averages the samples of every pixel into the picture; pixels without a mesh stay as they are.
    void copy(const Raster& raster, int samples, int x, int y, int width, int height, float opacity) {
        cairo_surface_flush(surface_.get());
        unsigned char* const data = cairo_image_surface_get_data(surface_.get());
        const int stride = cairo_image_surface_get_stride(surface_.get());
        for (int row = std::max(0, -y); row < height && y + row < cairo_image_surface_get_height(surface_.get());
             ++row) {
            for (int column = std::max(0, -x);
                 column < width && x + column < cairo_image_surface_get_width(surface_.get()); ++column) {
                Eigen::Vector3f sum = Eigen::Vector3f::Zero();
                bool is_covered = false;
                for (int k = 0; k < samples * samples; ++k) {
                    const size_t place = size_t(samples * row + k / samples) * size_t(raster.width) +
                                         size_t(samples * column + k % samples);
                    sum += raster.color[place];
                    is_covered |= std::isfinite(raster.depth[place]);
                }
                if (is_covered) {
                    unsigned char* const pixel = data + (y + row) * stride + 4 * (x + column);
                    for (int channel = 0; channel < 3; ++channel) {
                        const float value = std::clamp(sum(channel) / float(samples * samples), 0.0F, 1.0F);
                        const float below = float(pixel[2 - channel]);
                        pixel[2 - channel] =
                            static_cast<unsigned char>(std::lround(below + opacity * (255.0F * value - below)));
                    }
                }
            }
        }
        cairo_surface_mark_dirty(surface_.get());
    }

    std::unique_ptr<cairo_surface_t, SurfaceDestroy> surface_;
    std::unique_ptr<cairo_t, ContextDestroy> cairo_;
};

}  // namespace examples
