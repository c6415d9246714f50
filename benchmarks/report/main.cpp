// SPDX-License-Identifier: MIT
// softtissue_benchmark_report <folder>: from the JSON files of benchmarks in a folder, report.md and roofline.png in it.
#include "report.hpp"
#include "roofline.hpp"

#include <softtissue/core/error.hpp>
#include <softtissue/io/atomic_file.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace benchmarks;

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void run(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".json") {
            files.push_back(entry.path());
        }
    }
    softtissue::require(!files.empty(), folder.string(), ": no JSON file, expected those of --benchmark_out");
    std::sort(files.begin(), files.end());
    std::vector<Measurement> all;
    for (const std::filesystem::path& file : files) {
        std::vector<Measurement> some = read_measurements(read_text(file), file.stem().string());
        std::move(some.begin(), some.end(), std::back_inserter(all));
    }
    const std::string machine = read_text(folder / "machine.md");  // what the measuring script noted, if it did
    softtissue::AtomicFile report(folder / "report.md");
    report.write(markdown(all, "# Kernels, baselines, limits\n\n" + machine));
    report.commit();
    examples::write_line_chart(folder / "roofline.png", roofline(all));
    std::printf("%s\n%s\n", (folder / "report.md").string().c_str(), (folder / "roofline.png").string().c_str());
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: softtissue_benchmark_report <folder with JSON files>\n");
        return 2;
    }
    try {
        run(arguments[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "softtissue_benchmark_report: %s\n", error.what());
        return 1;
    }
    return 0;
}
