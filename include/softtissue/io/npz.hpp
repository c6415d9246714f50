// SPDX-License-Identifier: MIT
/// @file
/// Files of named numpy arrays (.npz).
///
/// What        reads every array of a file into memory (stored or deflated members, zip64); writes a file at once.
/// Refuses     a file that is missing, no zip archive, cut off, damaged (the checksum of every member is verified), or that
///             claims members larger than it can hold, each or together (InvalidInput names file and array).
/// Example     const NpzFile file = read_npz("walk.npz");
///             const Matrix3X<double> translations = file.at("trans").columns3<double>();
///             write_npz("out.npz", {{"x", NpyArray::from_columns(x)}});
/// Cost        writing holds the file in memory once more
/// Needs       libzip (link with -lzip)
/// Tests       tests/unit/io/npz_test.cpp
#pragma once

#if !__has_include(<zip.h>)
#error "softtissue: io/npz.hpp needs libzip (Debian: libzip-dev)"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/npy_array.hpp>

#include <zip.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace softtissue {

/// Arrays by name.
using NpyArrays = std::map<std::string, NpyArray>;

enum class NpzCompression { stored, deflated };

/// The arrays of one .npz file.
class NpzFile {
public:
    NpzFile(std::string path, NpyArrays arrays) : path_(std::move(path)), arrays_(std::move(arrays)) {}

    const std::string& path() const { return path_; }
    const NpyArrays& arrays() const { return arrays_; }
    bool contains(const std::string& name) const { return arrays_.count(name) > 0; }

    /// The array `name`; the error for a missing one lists those that are there.
    const NpyArray& at(const std::string& name) const {
        const auto found = arrays_.find(name);
        if (found == arrays_.end()) {
            std::string names;
            for (const auto& entry : arrays_) {
                names += (names.empty() ? "" : ", ") + entry.first;
            }
            throw_invalid_input(path_, ": array '", name, "' is missing; the file has ",
                                names.empty() ? "no arrays" : names);
        }
        return found->second;
    }

private:
    std::string path_;
    NpyArrays arrays_;
};

namespace detail {

struct ZipDiscard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct ZipMemberClose {
    void operator()(zip_file_t* member) const { zip_fclose(member); }
};
struct ZipSourceFree {
    void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using ZipArchive = std::unique_ptr<zip_t, ZipDiscard>;
using ZipSource = std::unique_ptr<zip_source_t, ZipSourceFree>;

inline ZipArchive open_zip(const std::string& path) {
    int code = 0;
    ZipArchive archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (archive == nullptr) {
        zip_error_t error;
        zip_error_init_with_code(&error, code);
        const std::string reason = zip_error_strerror(&error);
        zip_error_fini(&error);
        throw_invalid_input(path, ": cannot be opened as an npz (zip) file: ", reason);
    }
    return archive;
}

/// The content of member `index`, its size and checksum verified. Of the `unclaimed` bytes of the file it takes its own, so
/// that many members cannot share the same ones.
inline std::vector<unsigned char> read_zip_member(zip_t* archive, zip_uint64_t index, const std::string& source,
                                                  std::uintmax_t& unclaimed) {
    zip_stat_t stat;
    zip_stat_init(&stat);
    const bool has_sizes = zip_stat_index(archive, index, 0, &stat) == 0 && (stat.valid & ZIP_STAT_SIZE) != 0 &&
                           (stat.valid & ZIP_STAT_COMP_SIZE) != 0;
    require(has_sizes, source, ": its directory entry is damaged: ", zip_strerror(archive));
    constexpr zip_uint64_t largest_deflate_ratio = 1032;  // 258 bytes from 2 bits
    require(stat.comp_size <= unclaimed && stat.size / largest_deflate_ratio <= stat.comp_size, source, ": claims ",
            stat.size, " bytes, more than a file of this size can hold");
    unclaimed -= stat.comp_size;
    const std::unique_ptr<zip_file_t, ZipMemberClose> member(zip_fopen_index(archive, index, 0));
    require(member != nullptr, source, ": cannot be read: ", zip_strerror(archive));

    std::vector<unsigned char> bytes(stat.size);
    std::size_t filled = 0;
    unsigned char beyond = 0;
    for (;;) {  // reads on to the end, where the checksum is compared
        const bool full = filled == bytes.size();
        const zip_int64_t got = full ? zip_fread(member.get(), &beyond, 1)
                                     : zip_fread(member.get(), bytes.data() + filled, bytes.size() - filled);
        require(got >= 0, source, ": is damaged: ", zip_file_strerror(member.get()));
        require(got == 0 || !full, source, ": is longer than the ", bytes.size(), " bytes it claims");
        if (got == 0) {
            break;
        }
        filled += static_cast<std::size_t>(got);
    }
    require(filled == bytes.size(), source, ": is cut off after ", filled, " of ", bytes.size(), " bytes");
    return bytes;
}

/// The content of an archive that was written to memory: libzip's own way to a file leaves temporary files behind where
/// the process is killed.
inline void write_zip_source(zip_source_t* source, AtomicFile& file) {
    std::vector<unsigned char> bytes(std::size_t(1) << 16);
    require(zip_source_open(source) == 0, file.path().string(),
            ": cannot write: ", zip_error_strerror(zip_source_error(source)));
    zip_int64_t got = 0;
    while ((got = zip_source_read(source, bytes.data(), bytes.size())) > 0) {
        file.write(bytes.data(), std::size_t(got));
    }
    require(got == 0, file.path().string(), ": cannot write: ", zip_error_strerror(zip_source_error(source)));
    zip_source_close(source);
}

}  // namespace detail

/// Reads all arrays of `path`. Members that are not .npy files are skipped.
inline NpzFile read_npz(const std::filesystem::path& path) {
    const std::string file = path.string();
    require(!std::filesystem::is_directory(path), file, ": is a folder, expected an npz file");
    const detail::ZipArchive archive = detail::open_zip(file);
    std::uintmax_t unclaimed = std::filesystem::file_size(path);
    NpyArrays arrays;
    const zip_int64_t members = zip_get_num_entries(archive.get(), 0);
    for (zip_int64_t m = 0; m < members; ++m) {
        const auto index = static_cast<zip_uint64_t>(m);
        const char* const member_name = zip_get_name(archive.get(), index, 0);
        require(member_name != nullptr, file, ": member ", m, " has no readable name");
        std::string name = member_name;
        if (!name.ends_with(".npy")) {
            continue;
        }
        name.resize(name.size() - 4);
        const std::string source = file + ": array '" + name + "'";
        require(arrays.count(name) == 0, source, ": appears twice");
        arrays.emplace(name, NpyArray(source, detail::read_zip_member(archive.get(), index, source, unclaimed)));
    }
    return {file, std::move(arrays)};
}

/// Writes `arrays` to `path`: complete, or not at all. The same arrays give the same bytes.
inline void write_npz(const std::filesystem::path& path, const NpyArrays& arrays,
                      NpzCompression compression = NpzCompression::stored) {
    const std::string file = path.string();
    require(!arrays.empty(), file, ": no arrays to write");
    AtomicFile output(path);
    zip_error_t error;
    zip_error_init(&error);
    const detail::ZipSource content(zip_source_buffer_create(nullptr, 0, 0, &error));
    detail::ZipArchive archive(
        content == nullptr ? nullptr : zip_open_from_source(content.get(), ZIP_CREATE | ZIP_TRUNCATE, &error));
    require(archive != nullptr, file, ": cannot write: ", zip_error_strerror(&error));
    zip_source_keep(content.get());  // one owner here, one in the archive
    for (const auto& [name, array] : arrays) {
        const std::span<const unsigned char> bytes = array.file_bytes();
        zip_source_t* const source = zip_source_buffer(archive.get(), bytes.data(), bytes.size(), 0);
        require(source != nullptr, file, ": array '", name, "': ", zip_strerror(archive.get()));
        const zip_int64_t index = zip_file_add(archive.get(), (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) {
            zip_source_free(source);
            throw_invalid_input(file, ": array '", name, "': ", zip_strerror(archive.get()));
        }
        const auto member = static_cast<zip_uint64_t>(index);
        const zip_int32_t method = compression == NpzCompression::stored ? ZIP_CM_STORE : ZIP_CM_DEFLATE;
        constexpr zip_uint16_t first_of_january_1980 = 33;  // the earliest date of the format: no trace of the clock
        constexpr zip_uint32_t deflate_level = 6;  // libzip's own default, 9, takes ten times as long for no gain
        const bool set = zip_set_file_compression(archive.get(), member, method, deflate_level) == 0 &&
                         zip_file_set_dostime(archive.get(), member, 0, first_of_january_1980, 0) == 0;
        require(set, file, ": array '", name, "': ", zip_strerror(archive.get()));
    }
    require(zip_close(archive.get()) == 0, file, ": cannot write: ", zip_strerror(archive.get()));
    static_cast<void>(archive.release());  // closed
    detail::write_zip_source(content.get(), output);
    output.commit();
}

}  // namespace softtissue
