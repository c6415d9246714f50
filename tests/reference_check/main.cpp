// SPDX-License-Identifier: MIT
// softtissue_reference_check DIR [--lbs FILE --bodies DIR]: compares the library with results of independent software.
#include "reference_case.hpp"

#include <softtissue/core/error.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace reference_check;

struct Subject {
    const char* prefix;
    void (*check)(const ReferenceCase&, Checklist&);
    const char* missing;  // why there is no check, if there is none
};

// The first prefix that fits decides: the longer ones come first.
constexpr Subject subjects[] = {
    {"o1_", check_material, nullptr},
    {"o2_prism_static", check_static_prisms, nullptr},
    {"o2_prism", check_prism, nullptr},
    {"o2_tet", check_tet, nullptr},
    {"o3_", check_static_tets, nullptr},
    {"o4_", check_dynamics, nullptr},
    {"o5_matexp", check_matrix_exponential, nullptr},
    {"o5_mlp", check_mlp, nullptr},
    {"o5_train", check_training, nullptr},
    {"o6_tri", check_triangle_geometry, nullptr},
    {"o6_tet", check_tet_geometry, nullptr},
    {"o6_winding", check_winding_number, nullptr},
    {"o6_shell", check_shell, nullptr},
    {"o7_", check_skinning, nullptr},
};

struct Arguments {
    std::string folder;
    std::string lbs;
    std::string bodies;
};

bool parse(int argc, char** argv, Arguments& arguments) {
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if ((word == "--lbs" || word == "--bodies") && i + 1 < argc) {
            (word == "--lbs" ? arguments.lbs : arguments.bodies) = argv[++i];
        } else if (word.rfind("--", 0) != 0 && arguments.folder.empty()) {
            arguments.folder = word;
        } else {
            return false;
        }
    }
    return !arguments.folder.empty() && arguments.lbs.empty() == arguments.bodies.empty();
}

void check_file(const std::filesystem::path& path, Checklist& checks) {
    const std::string name = path.stem().string();
    for (const Subject& subject : subjects) {
        if (name.rfind(subject.prefix, 0) == 0) {
            if (subject.check == nullptr) {
                checks.skip(name, subject.missing);
            } else {
                subject.check({name, softtissue::read_npz(path)}, checks);
            }
            return;
        }
    }
    checks.skip(name, "not a case of the known schema");
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    if (!parse(argc, argv, arguments)) {
        std::fprintf(stderr, "usage: softtissue_reference_check DIR [--lbs FILE --bodies DIR]\n");
        return 2;
    }
    Checklist checks;
    try {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(arguments.folder)) {
            if (entry.path().extension() == ".npz") {
                files.push_back(entry.path());
            }
        }
        std::sort(files.begin(), files.end());
        for (const std::filesystem::path& file : files) {
            check_file(file, checks);
        }
        if (!arguments.lbs.empty()) {
            check_smpl_bodies(arguments.lbs, arguments.bodies, checks);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "softtissue_reference_check: %s\n", error.what());
        return 1;
    }
    if (checks.num_checks() == 0) {
        std::fprintf(stderr, "softtissue_reference_check: %s has no cases\n", arguments.folder.c_str());
        return 1;
    }
    std::printf("%d checks, %d failed\n", checks.num_checks(), checks.num_failed());
    return checks.num_failed() == 0 ? 0 : 1;
}
