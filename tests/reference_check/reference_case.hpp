// SPDX-License-Identifier: MIT
/// @file
/// One file of reference results, and the lines that compare the library with it.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/io/npz.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace reference_check {

using softtissue::Index;

/// Prints one line a quantity and remembers failures.
class Checklist {
public:
    /// `error` and `tolerance` in the unit that `quantity` names; NaN fails.
    void add(const std::string& name, const char* quantity, double error, double tolerance) {
        const bool passed = error <= tolerance;
        std::printf("%-28s %-34s error %9.2e  tolerance %7.0e  %s\n", name.c_str(), quantity, error, tolerance,
                    passed ? "pass" : "FAIL");
        std::fflush(stdout);
        ++num_checks_;
        num_failed_ += passed ? 0 : 1;
    }

    void skip(const std::string& name, const char* reason) { std::printf("%-28s skipped: %s\n", name.c_str(), reason); }

    int num_checks() const { return num_checks_; }
    int num_failed() const { return num_failed_; }

private:
    int num_checks_ = 0;
    int num_failed_ = 0;
};

/// The arrays of one case; the name is that of its file.
struct ReferenceCase {
    std::string name;
    softtissue::NpzFile file;

    bool has(const char* array) const { return file.contains(array); }

    double scalar(const char* array) const { return file.at(array).scalar<double>(); }

    /// All numbers of an array of any shape, in C order.
    softtissue::VectorX<double> flat(const char* array) const {
        const std::vector<double> values = file.at(array).as<double>();
        return Eigen::Map<const softtissue::VectorX<double>>(values.data(), Index(values.size()));
    }

    /// An (n, 3) array as 3 x n.
    softtissue::Matrix3X<double> points(const char* array) const { return file.at(array).columns3<double>(); }
};

/// max |a - b| over max |b|, or over `scale` if that is given.
template <class A, class B>
double relative_difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b, double scale = 0.0) {
    const double reference = scale > 0.0 ? scale : double(b.cwiseAbs().maxCoeff());
    return double((a - b).cwiseAbs().maxCoeff()) / (reference > 0.0 ? reference : 1.0);
}

/// The longest edge of the bounding box of `points`.
inline double box_size(const softtissue::Matrix3X<double>& points) {
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
}

void check_material(const ReferenceCase& reference, Checklist& checks);
void check_tet(const ReferenceCase& reference, Checklist& checks);
void check_prism(const ReferenceCase& reference, Checklist& checks);
void check_static_tets(const ReferenceCase& reference, Checklist& checks);
void check_static_prisms(const ReferenceCase& reference, Checklist& checks);
void check_dynamics(const ReferenceCase& reference, Checklist& checks);
void check_matrix_exponential(const ReferenceCase& reference, Checklist& checks);
void check_mlp(const ReferenceCase& reference, Checklist& checks);
void check_training(const ReferenceCase& reference, Checklist& checks);
void check_triangle_geometry(const ReferenceCase& reference, Checklist& checks);
void check_tet_geometry(const ReferenceCase& reference, Checklist& checks);
void check_winding_number(const ReferenceCase& reference, Checklist& checks);
void check_shell(const ReferenceCase& reference, Checklist& checks);
void check_skinning(const ReferenceCase& reference, Checklist& checks);
void check_smpl_bodies(const std::filesystem::path& reference, const std::filesystem::path& bodies, Checklist& checks);

}  // namespace reference_check
