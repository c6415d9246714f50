// SPDX-License-Identifier: MIT
// Every law finds the element that breaks it.
#include <softtissue/testing/element_laws.hpp>

#include <softtissue/element/tet4.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

using Cell = NodePositions<Tet4, double>;
using CellValues = NodeValues<Tet4, double>;

enum class Fault {
    none,
    volume_without_sign,
    bound_without_sign,
    bound_not_a_volume,
    gradient_too_large,
    gradient_not_balanced,
    integrals_too_large,
    integrals_uneven,
    shapes_exchanged,
    inverse_too_large,
    inverse_never_found,
    shape_gradients_too_large,
};

/// A Tet4 with one fault; one type, so that the suite is compiled once.
struct FaultyTet {
    static inline Fault fault = Fault::none;
    static inline std::vector<ElementFace> faces{Tet4::faces.begin(), Tet4::faces.end()};
    static inline std::vector<std::array<int, 4>> symmetries{Tet4::symmetries.begin(), Tet4::symmetries.end()};

    static constexpr int num_nodes = 4;
    static double rest_volume(const Cell& X) {
        const double volume = Tet4::rest_volume(X);
        return fault == Fault::volume_without_sign ? std::abs(volume) : volume;
    }
    static Cell gradient_operator(const Cell& X) {
        Cell g = Tet4::gradient_operator(X);
        if (fault == Fault::gradient_not_balanced) {
            g.col(0).setZero();
        }
        return fault == Fault::gradient_too_large ? Cell(1.001 * g) : g;
    }
    static CellValues shape_integrals(const Cell& X) {
        if (fault == Fault::integrals_uneven) {
            return CellValues(0.4, 0.2, 0.2, 0.2) * Tet4::rest_volume(X);
        }
        return Tet4::shape_integrals(X) * (fault == Fault::integrals_too_large ? 2 : 1);
    }
    static CellValues shape_values(const Vector3<double>& xi) {
        return Tet4::shape_values(fault == Fault::shapes_exchanged ? Vector3<double>(xi(1), xi(0), xi(2)) : xi);
    }
    static Cell shape_gradients(const Cell& X, const Vector3<double>& xi) {
        return Tet4::shape_gradients(X, xi) * (fault == Fault::shape_gradients_too_large ? 1.001 : 1);
    }
    static Vector3<double> position(const Cell& X, const Vector3<double>& xi) { return Tet4::position(X, xi); }
    static NaturalCoordinates<double> natural_coordinates(const Cell& X, const Vector3<double>& p) {
        NaturalCoordinates<double> found = Tet4::natural_coordinates(X, p);
        found.coordinates(0) *= fault == Fault::inverse_too_large ? 1.001 : 1;
        found.converged = fault != Fault::inverse_never_found;
        return found;
    }
    static double smallest_jacobian_bound(const Cell& X) {
        const double bound = Tet4::smallest_jacobian_bound(X);
        if (fault == Fault::bound_not_a_volume) {
            return bound * std::abs(bound);
        }
        return fault == Fault::bound_without_sign ? std::abs(bound) : bound;
    }
};

static_assert(Element<FaultyTet>);

Cell unit_tet() {
    Cell X;
    X << 0, 1, 0, 0,  //
        0, 0, 1, 0,   //
        0, 0, 0, 1;
    return X;
}

LawReport report_with(Fault fault) {
    FaultyTet::fault = fault;
    const LawReport report = check_element_laws<FaultyTet, double>(unit_tet(), {.samples = 10});
    FaultyTet::fault = Fault::none;
    return report;
}

void check_broken(const LawReport& report, const char* law) {
    INFO(report.summary());
    REQUIRE(report.has(law));
    CHECK_FALSE(report[law].passed);
}

}  // namespace

TEST_CASE("an element without fault passes, the same seed gives the same report") {
    const LawReport report = report_with(Fault::none);
    INFO(report.summary());
    CHECK(report.all_passed());
    CHECK(report.summary() == report_with(Fault::none).summary());
}

TEST_CASE("laws of the cell find their fault") {
    check_broken(report_with(Fault::volume_without_sign), "mirrored cell");
    check_broken(report_with(Fault::bound_without_sign), "mirrored bound");
    check_broken(report_with(Fault::gradient_too_large), "affine maps");
    check_broken(report_with(Fault::gradient_not_balanced), "partition of unity");
    check_broken(report_with(Fault::integrals_too_large), "shape integrals");
}

TEST_CASE("laws of the shape functions find their fault") {
    check_broken(report_with(Fault::shapes_exchanged), "node values");
    check_broken(report_with(Fault::inverse_too_large), "inverse map");
    check_broken(report_with(Fault::inverse_never_found), "inverse map");
    check_broken(report_with(Fault::shape_gradients_too_large), "shape gradient rate");
}

TEST_CASE("laws of symmetry find their fault") {
    check_broken(report_with(Fault::bound_not_a_volume), "similarity");
    check_broken(report_with(Fault::integrals_uneven), "symmetries");
    const auto symmetries = FaultyTet::symmetries;
    FaultyTet::symmetries.push_back({1, 0, 2, 3});
    check_broken(report_with(Fault::none), "symmetries");
    FaultyTet::symmetries = symmetries;
}

TEST_CASE("laws of the faces find their fault") {
    const auto faces = FaultyTet::faces;
    std::swap(FaultyTet::faces[0].nodes[0], FaultyTet::faces[0].nodes[1]);
    check_broken(report_with(Fault::none), "faces outward");
    check_broken(report_with(Fault::none), "faces closed");
    FaultyTet::faces.erase(FaultyTet::faces.begin());
    check_broken(report_with(Fault::none), "faces volume");
    FaultyTet::faces = faces;
}

TEST_CASE("a reference cell in the wrong order ends the suite with its first law") {
    Cell X = unit_tet();
    X.col(0).swap(X.col(1));
    const LawReport report = check_element_laws<FaultyTet, double>(X);
    REQUIRE(report.results.size() == 1);
    CHECK_FALSE(report["positive cell"].passed);
}
