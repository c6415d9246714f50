// SPDX-License-Identifier: MIT
/// @file
/// TetGen as a Tetrahedraliser, for tests that are built with it.
#pragma once

#include <softtissue/anatomy/tetrahedral_layer.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <tetgen.h>

#include <algorithm>
#include <string>
#include <utility>

namespace softtissue {

/// The boundary is kept (-pYY), the mesher is quiet.
struct TetGenMesher {
    Tetrahedralisation<double> operator()(const Matrix3X<double>& positions, const Triangles& triangles) const {
        tetgenio in;
        tetgenio out;
        in.numberofpoints = int(positions.cols());
        in.pointlist = new REAL[size_t(positions.size())];
        std::copy(positions.data(), positions.data() + positions.size(), in.pointlist);
        in.numberoffacets = int(triangles.cols());
        in.facetlist = new tetgenio::facet[size_t(triangles.cols())];
        for (Index t = 0; t < triangles.cols(); ++t) {
            tetgenio::facet& facet = in.facetlist[t];
            tetgenio::init(&facet);
            facet.numberofpolygons = 1;
            facet.polygonlist = new tetgenio::polygon[1];
            tetgenio::init(facet.polygonlist);
            facet.polygonlist->numberofvertices = 3;
            facet.polygonlist->vertexlist = new int[3]{triangles(0, t), triangles(1, t), triangles(2, t)};
        }
        std::string switches = extra + "pYYQ";
        tetrahedralize(switches.data(), &in, &out);
        Tetrahedralisation<double> result{
            Eigen::Map<const Matrix3X<double>>(out.pointlist, 3, out.numberofpoints),
            Eigen::Map<const Connectivity<4>>(out.tetrahedronlist, 4, out.numberoftetrahedra)};
        for (Index c = 0; c < result.tets.cols(); ++c) {
            if (Tet4::rest_volume(CellMesh<Tet4, double>::gather(result.positions, result.tets.col(c))) < 0) {
                std::swap(result.tets(0, c), result.tets(1, c));
            }
        }
        return result;
    }

    std::string extra = "";  // further switches, such as q for vertices inside
};

}  // namespace softtissue
