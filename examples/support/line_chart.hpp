// SPDX-License-Identifier: MIT
/// @file
/// Charts of lines with legend and titles, written as PNG.
#pragma once

#include "chart.hpp"
#include "chart_axis.hpp"
#include "mesh_picture.hpp"

#include <softtissue/core/error.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace examples {

/// Colours that also differ for eyes that do not tell red from green; the eighth series has the first one's again.
inline Eigen::Vector3f series_color(size_t index) {
    static const std::array<Eigen::Vector3f, 7> colors{
        Eigen::Vector3f(0.00F, 0.35F, 0.65F), Eigen::Vector3f(0.84F, 0.37F, 0.00F),
        Eigen::Vector3f(0.00F, 0.58F, 0.42F), Eigen::Vector3f(0.75F, 0.42F, 0.62F),
        Eigen::Vector3f(0.90F, 0.62F, 0.00F), Eigen::Vector3f(0.34F, 0.70F, 0.91F),
        Eigen::Vector3f(0.35F, 0.35F, 0.35F)};
    return colors[index % colors.size()];
}

namespace detail {

class ChartDrawing {
public:
    explicit ChartDrawing(const LineChart& chart)
        : chart_(chart), picture_(chart.width, chart.height), x_axis_(chart.is_log_x), y_axis_(chart.is_log_y) {
        for (const LineSeries& series : chart.series) {
            softtissue::require(series.x.size() == series.y.size(), "line chart: series \"", series.name, "\" has ",
                                series.x.size(), " x and ", series.y.size(), " y, expected equal numbers");
            for (size_t k = 0; k < series.x.size(); ++k) {
                if (x_axis_.shows(series.x[k]) && y_axis_.shows(series.y[k])) {
                    x_axis_.include(series.x[k]);
                    y_axis_.include(series.y[k]);
                }
            }
        }
        x_axis_.finish(0.0);
        y_axis_.finish(0.05);
    }

    Picture& draw() {
        picture_.text(chart_.title, left, 40, 22);
        draw_legend();
        draw_grid();
        cairo_t* const cairo = picture_.context();
        cairo_save(cairo);
        cairo_rectangle(cairo, left, top_, right() - left, bottom() - top_);
        cairo_clip(cairo);
        for (size_t k = 0; k < chart_.series.size(); ++k) {
            draw_line(chart_.series[k], series_color(k));
        }
        cairo_restore(cairo);
        for (size_t k = 0; k < chart_.series.size(); ++k) {
            draw_points(chart_.series[k], series_color(k));
        }
        for (const LineMark& mark : chart_.marks) {
            draw_mark(mark);
        }
        return picture_;
    }

private:
    static constexpr double left = 92.0;
    double right() const { return chart_.width - 32.0; }
    double bottom() const { return chart_.height - 66.0; }
    double pixel_x(double value) const { return left + x_axis_.place(value) * (right() - left); }
    double pixel_y(double value) const { return bottom() - y_axis_.place(value) * (bottom() - top_); }

    void set_color(const Eigen::Vector3f& color) {
        cairo_set_source_rgb(picture_.context(), double(color(0)), double(color(1)), double(color(2)));
    }

    void stroke(double x0, double y0, double x1, double y1) {
        cairo_move_to(picture_.context(), x0, y0);
        cairo_line_to(picture_.context(), x1, y1);
        cairo_stroke(picture_.context());
    }

    void dot(double x, double y) {
        cairo_arc(picture_.context(), x, y, 3.4, 0.0, 4.0 * std::acos(0.0));
        cairo_fill(picture_.context());
    }

    /// In rows above the plot, which begins below it.
    void draw_legend() {
        cairo_t* const cairo = picture_.context();
        double x = left;
        for (size_t k = 0; k < chart_.series.size(); ++k) {
            const double width = 52.0 + picture_.text_width(chart_.series[k].name, 15);
            if (x > left && x + width > right()) {
                x = left;
                top_ += 24.0;
            }
            set_color(series_color(k));
            set_stroke(chart_.series[k]);
            if (chart_.series[k].has_line) {
                stroke(x, top_ - 33.0, x + 26.0, top_ - 33.0);
            } else {
                dot(x + 13.0, top_ - 33.0);
            }
            cairo_set_dash(cairo, nullptr, 0, 0.0);
            picture_.text(chart_.series[k].name, x + 33.0, top_ - 28.0, 15);
            x += width + 10.0;
        }
    }

    void draw_grid() {
        cairo_t* const cairo = picture_.context();
        const auto line = [&](bool is_labelled, double x0, double y0, double x1, double y1) {
            const float gray = is_labelled ? 0.86F : 0.94F;
            set_color({gray, gray, gray});
            cairo_set_line_width(cairo, 1.0);
            stroke(std::round(x0) + 0.5, std::round(y0) + 0.5, std::round(x1) + 0.5, std::round(y1) + 0.5);
        };
        double free_from = 0.0;  // labels keep clear of each other
        for (const ChartAxis::Tick& tick : x_axis_.ticks(8)) {
            const double x = pixel_x(tick.value), half = 0.5 * picture_.text_width(tick.label, 15);
            line(!tick.label.empty(), x, top_, x, bottom());
            if (!tick.label.empty() && x - half > free_from) {
                picture_.text(tick.label, x, bottom() + 23.0, 15, 0.5);
                free_from = x + half + 8.0;
            }
        }
        free_from = bottom() + 20.0;
        for (const ChartAxis::Tick& tick : y_axis_.ticks(6)) {
            const double y = pixel_y(tick.value);
            line(!tick.label.empty(), left, y, right(), y);
            if (!tick.label.empty() && y < free_from) {
                picture_.text(tick.label, left - 10.0, y + 5.0, 15, 1.0);
                free_from = y - 18.0;
            }
        }
        set_color({0.35F, 0.35F, 0.35F});
        cairo_set_line_width(cairo, 1.2);
        stroke(left, bottom(), right(), bottom());
        stroke(left, top_, left, bottom());
        picture_.text(chart_.x_title, 0.5 * (left + right()), chart_.height - 17.0, 16, 0.5);
        cairo_save(cairo);
        cairo_translate(cairo, 28.0, 0.5 * (top_ + bottom()));
        cairo_rotate(cairo, -std::acos(0.0));
        picture_.text(chart_.y_title, 0.0, 0.0, 16, 0.5);
        cairo_restore(cairo);
    }

    void set_stroke(const LineSeries& series) {
        static constexpr double dash[2] = {7.0, 5.0};
        cairo_set_line_width(picture_.context(), 2.2);
        cairo_set_line_join(picture_.context(), CAIRO_LINE_JOIN_ROUND);
        cairo_set_dash(picture_.context(), dash, series.is_dashed ? 2 : 0, 0.0);
    }

    void draw_line(const LineSeries& series, const Eigen::Vector3f& color) {
        cairo_t* const cairo = picture_.context();
        if (!series.has_line) {
            return;
        }
        set_color(color);
        set_stroke(series);
        bool is_open = false;
        for (size_t k = 0; k < series.x.size(); ++k) {
            if (!x_axis_.shows(series.x[k]) || !y_axis_.shows(series.y[k])) {
                is_open = false;
                continue;
            }
            const double x = pixel_x(series.x[k]), y = pixel_y(series.y[k]);
            is_open ? cairo_line_to(cairo, x, y) : cairo_move_to(cairo, x, y);
            is_open = true;
        }
        cairo_stroke(cairo);
        cairo_set_dash(cairo, nullptr, 0, 0.0);
    }

    /// Where there are few.
    void draw_points(const LineSeries& series, const Eigen::Vector3f& color) {
        const bool are_wanted = !series.has_line || (series.x.size() <= 40 && !series.is_dashed);
        for (size_t k = 0; k < series.x.size() && are_wanted; ++k) {
            if (x_axis_.shows(series.x[k]) && y_axis_.shows(series.y[k])) {
                const double x = pixel_x(series.x[k]), y = pixel_y(series.y[k]);
                set_color(color);
                dot(x, y);
                if (k < series.labels.size()) {
                    picture_.text(series.labels[k], x + 6.0, y - 5.0, 13);
                }
            }
        }
    }

    void draw_mark(const LineMark& mark) {
        const double x = pixel_x(mark.x);
        if (!x_axis_.shows(mark.x) || x < left || x > right()) {
            return;
        }
        static constexpr double dots[2] = {2.0, 4.0};
        set_color({0.25F, 0.25F, 0.25F});
        cairo_set_line_width(picture_.context(), 1.4);
        cairo_set_dash(picture_.context(), dots, 2, 0.0);
        stroke(x, top_, x, bottom());
        cairo_set_dash(picture_.context(), nullptr, 0, 0.0);
        const bool is_right = x > 0.5 * (left + right());
        picture_.text(mark.label, is_right ? x - 7.0 : x + 7.0, top_ + 16.0, 14, is_right ? 1.0 : 0.0);
    }

    const LineChart& chart_;
    Picture picture_;
    ChartAxis x_axis_, y_axis_;
    double top_ = 94.0;
};

}  // namespace detail

inline void write_line_chart(const std::filesystem::path& path, const LineChart& chart) {
    detail::ChartDrawing(chart).draw().write(path);
}

}  // namespace examples
