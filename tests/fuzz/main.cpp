// SPDX-License-Identifier: MIT
// One program for all fuzz targets.
//
// With libFuzzer (clang, SOFTTISSUE_LIBFUZZER):   softtissue_fuzz --target=npz [options of libFuzzer] [folders]
// With any other compiler:                        softtissue_fuzz corpus [targets]
// runs each target over its seeds and past findings, the files in corpus/<target>.
#include "target.hpp"

#include <support/temporary_folder.hpp>

#include <softtissue/core/error.hpp>

#include <algorithm>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <vector>

#ifdef SOFTTISSUE_LIBFUZZER
#include "mutation.hpp"
#endif

namespace softtissue_fuzz {

namespace {

std::vector<Target> all_targets() {
    std::vector<Target> all;
    for (const std::span<const Target> some : {npz_targets(), json_targets(), text_targets(), agreement_targets()}) {
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

bool run(const Target& target, Bytes bytes) {
    return is_accepted([&] { target.run(bytes); });
}

}  // namespace

const std::filesystem::path& input_folder() {
    static const softtissue_test::TemporaryFolder folder;
    return folder.path();
}

std::filesystem::path input_file(std::string_view name, std::string_view bytes) {
    std::filesystem::path path = input_folder() / name;
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

}  // namespace softtissue_fuzz

#ifdef SOFTTISSUE_LIBFUZZER

namespace {
softtissue_fuzz::Target chosen;
}

// libFuzzer passes over options that begin with two dashes, also where it starts itself again.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    constexpr std::string_view option = "--target=";
    std::string_view name;
    for (int i = 1; i < *argc; ++i) {
        const std::string_view argument = (*argv)[i];
        name = argument.substr(0, option.size()) == option ? argument.substr(option.size()) : name;
    }
    std::string names;
    for (const softtissue_fuzz::Target& target : softtissue_fuzz::all_targets()) {
        if (target.name == name) {
            chosen = target;
        }
        names.append(" ").append(target.name);
    }
    if (chosen.run == nullptr) {
        std::fprintf(stderr, "expected --target= and one of:%s\n", names.c_str());
        std::exit(1);
    }
    softtissue_fuzz::input_folder();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    softtissue_fuzz::run(chosen, {data, size});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    const std::string mutated = softtissue_fuzz::mutated(
        chosen.container, std::string(reinterpret_cast<const char*>(data), size), max_size, seed);
    std::memcpy(data, mutated.data(), mutated.size());
    return mutated.size();
}

#else

namespace {

/// Runs over the files in `folder`.
void replay(const softtissue_fuzz::Target& target, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder), {});
    std::sort(files.begin(), files.end());
    int accepted = 0;
    for (const std::filesystem::path& file : files) {
        std::ifstream stream(file, std::ios::binary);
        const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream),
                                               std::istreambuf_iterator<char>()};
        try {
            accepted += softtissue_fuzz::run(target, bytes) ? 1 : 0;
        } catch (const std::exception& error) {
            std::fprintf(stderr, "%s: %s, expected InvalidInput\n", file.string().c_str(), error.what());
            std::abort();
        }
    }
    std::printf("%-16s %d of %d inputs accepted\n", std::string(target.name).c_str(), accepted,
                static_cast<int>(files.size()));
    softtissue_fuzz::expect(accepted > 0, "a seed is accepted");
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string_view> arguments(argv + 1, argv + argc);
    if (arguments.empty()) {
        std::fprintf(stderr, "expected the folder of the corpora\n");
        return 2;
    }
    for (const softtissue_fuzz::Target& target : softtissue_fuzz::all_targets()) {
        if (arguments.size() > 1 && std::find(arguments.begin() + 1, arguments.end(), target.name) == arguments.end()) {
            continue;
        }
        replay(target, std::filesystem::path(arguments[0]) / target.name);
    }
    return 0;
}

#endif
