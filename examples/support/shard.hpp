// SPDX-License-Identifier: MIT
/// @file
/// Which part of divided work this process does: told by "i/n", or by MPI where the program is built with it.
#pragma once

#include <softtissue/core/error.hpp>

#ifdef SOFTTISSUE_HAS_MPI
#include <mpi.h>
#endif

#include <charconv>
#include <string>
#include <string_view>

namespace examples {

struct Shard {
    int index = 0;
    int count = 1;
};

/// From "i/n", i from 0 to n - 1.
inline Shard parse_shard(const std::string& text) {
    Shard shard;
    const size_t slash = text.find('/');
    const auto is_number = [](std::string_view part, int& value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size() && !part.empty();
    };
    softtissue::require(slash != std::string::npos && is_number(std::string_view(text).substr(0, slash), shard.index) &&
                            is_number(std::string_view(text).substr(slash + 1), shard.count) && shard.index >= 0 &&
                            shard.index < shard.count,
                        "shard '", text, "', expected i/n with i from 0 to n - 1");
    return shard;
}

/// The whole of MPI's use: while it lives, one rank is one shard. Without MPI, one shard.
class MpiShard {
public:
    MpiShard() {
#ifdef SOFTTISSUE_HAS_MPI
        MPI_Init(nullptr, nullptr);
        MPI_Comm_rank(MPI_COMM_WORLD, &shard_.index);
        MPI_Comm_size(MPI_COMM_WORLD, &shard_.count);
#endif
    }
    MpiShard(const MpiShard&) = delete;
    MpiShard& operator=(const MpiShard&) = delete;
    ~MpiShard() {
#ifdef SOFTTISSUE_HAS_MPI
        MPI_Finalize();
#endif
    }

    Shard shard() const {
        return shard_;
    }

    /// Returns when all ranks have come here.
    void wait_for_all() const {
#ifdef SOFTTISSUE_HAS_MPI
        MPI_Barrier(MPI_COMM_WORLD);
#endif
    }

private:
    Shard shard_;
};

}  // namespace examples
