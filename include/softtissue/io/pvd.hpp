// SPDX-License-Identifier: MIT
/// @file
/// A time series of .vtu files for ParaView (.pvd).
///
/// What        the list of the files and their times; open it in ParaView to play the series.
/// Units       times in s.
/// Tests       tests/unit/io/pvd_test.cpp
#pragma once

#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/vtu.hpp>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace softtissue {

/// One file of a series, its name relative to the .pvd file.
struct PvdStep {
    double time;
    std::string file;
};

/// Writes the series.
inline void write_pvd(const std::filesystem::path& path, const std::vector<PvdStep>& steps) {
    std::ostringstream xml;
    xml.exceptions(std::ios::badbit);  // out of memory is told, not written as a shorter file
    xml.precision(17);
    xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (const PvdStep& step : steps) {
        xml << "<DataSet timestep=\"" << step.time << "\" part=\"0\" file=\"" << detail::xml_escaped(step.file)
            << "\"/>\n";
    }
    xml << "</Collection>\n</VTKFile>\n";
    AtomicFile file(path);
    file.write(xml.str());
    file.commit();
}

}  // namespace softtissue
