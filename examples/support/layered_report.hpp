// SPDX-License-Identifier: MIT
/// @file
/// Layered bodies on a page: a view for each method, skin, wraps, muscles and bones as layers of it.
#pragma once

#include "html_report.hpp"
#include "layered_scene.hpp"

#include <string>
#include <vector>

namespace examples {

class LayeredReport {
public:
    /// `has_reference`: the first method is what the others are compared with. `frames`: how many there will be.
    LayeredReport(HtmlReport::Heading heading, const Scene& scene, const std::vector<std::string>& methods,
                  bool has_reference, Index frames);

    /// The next of the frames; it is seen if the page has room for it.
    void begin_frame(double time, const std::string& label = {});

    /// The frame by one method; `x` are the layers, and of the reference `reference`.
    void add(size_t method, const Scene::Frame& frame, const Matrix3X<Scalar>& x, const Matrix3X<Scalar>* reference);

    /// For figures, charts, tables, and to write it.
    HtmlReport& page() { return report_; }

private:
    struct Meshes {
        Index skin, muscle_wrap, bone_wrap, muscles, bones;
    };

    void add_layers(bool has_reference);
    Meshes add_meshes(const std::string& method);
    void set_columns(const Meshes& meshes, Index field, const VectorX<Scalar>& values);

    const Scene& scene_;
    HtmlReport report_;
    std::vector<Meshes> meshes_;
    Index volume_ = 0, error_ = -1, stride_ = 1;
    Index skin_ = 0, muscle_wrap_ = 0, bone_wrap_ = 0, muscles_ = 0, bones_ = 0;
    Index num_frames_ = 0, num_seen_ = 0;
    bool is_seen_ = false;
    double largest_change_ = -1.0;
};

}  // namespace examples
