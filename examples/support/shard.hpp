// SPDX-License-Identifier: MIT
/// @file
/// Which part of divided work this process does: told by "i/n", or by MPI where the program is built with it.
#pragma once

#include <softtissue/core/error.hpp>

#ifdef SOFTTISSUE_HAS_MPI
#define OMPI_SKIP_MPICXX  // the old C++ interface is a library of its own
#define MPICH_SKIP_MPICXX
#include <mpi.h>
#endif

#include <charconv>
#include <chrono>
#include <exception>
#include <string>
#include <string_view>
#include <thread>

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

    /// Rank 0 does it, and the others wait until it is done; where it throws, all ranks do.
    template <class Action>
    void first_alone(const Action& action) const {
        std::exception_ptr error;
        if (shard_.index == 0) {
            try {
                action();
            } catch (...) {
                error = std::current_exception();
            }
        }
#ifdef SOFTTISSUE_HAS_MPI
        int failed = error != nullptr;
        MPI_Request request;
        MPI_Ibcast(&failed, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
        for (int done = 0; done == 0;) {  // a blocking wait would keep a core busy that rank 0 may need
            MPI_Test(&request, &done, MPI_STATUS_IGNORE);
            std::this_thread::sleep_for(std::chrono::milliseconds(done == 0 ? 5 : 0));
        }
        softtissue::require(failed == 0 || error != nullptr, "rank 0 could not prepare the work; its message says why");
#endif
        if (error != nullptr) {
            std::rethrow_exception(error);
        }
    }

private:
    Shard shard_;
};

}  // namespace examples
