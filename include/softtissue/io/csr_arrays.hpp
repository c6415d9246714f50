// SPDX-License-Identifier: MIT
/// @file
/// A sparse matrix as four arrays of an .npz file: the parts of scipy's compressed-row format.
///
/// What        <name>_{data, indices, indptr, shape}, checked once; rows with ascending columns. A shape of more than two
///             extents means that the extents after the first are flattened into columns, the last one fastest.
/// Refuses     a missing part, another shape than expected, offsets that do not ascend from 0 to the number of entries, a
///             column out of range or twice in a row (InvalidInput names file, array and row).
/// Source      scipy, "scipy.sparse.csr_matrix"
/// Tests       tests/unit/io/csr_arrays_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/npz.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct CsrEntry {
    Index column;
    S value;
};

template <RealScalar S>
class CsrArrays {
public:
    /// An empty matrix to be filled by append().
    explicit CsrArrays(std::vector<Index> shape) : shape_(std::move(shape)) {
        offsets_.assign(std::size_t(shape_[0]) + 1, 0);
    }

    /// Reads the parts of `name`, which must have the shape `expected`.
    CsrArrays(const NpzFile& file, const std::string& name, const std::vector<Index>& expected)
        : source_(file.path() + ": " + name), shape_(expected) {
        const NpyArray& shape = part(file, name, "_shape");
        require(shape.as<Index>() == expected, shape.source(), ": not the shape expected from the other arrays");
        values_ = part(file, name, "_data").template as<S>();
        columns_ = part(file, name, "_indices").template as<std::int32_t>();
        offsets_ = part(file, name, "_indptr").template as<std::int64_t>();
        require(columns_.size() == values_.size(), source_, "_indices has ", columns_.size(), " entries, expected ",
                values_.size(), " as in ", name, "_data");
        require(Index(offsets_.size()) == shape_[0] + 1, source_, "_indptr has ", offsets_.size(),
                " entries, expected one more than the ", shape_[0], " rows");
        require(offsets_.front() == 0 && std::is_sorted(offsets_.begin(), offsets_.end()) &&
                    offsets_.back() == Index(values_.size()),
                source_, "_indptr does not ascend from 0 to the ", values_.size(), " entries of ", name, "_data");
    }

    /// The entries of row r, columns ascending.
    std::vector<CsrEntry<S>> sorted_row(Index r) const {
        std::vector<CsrEntry<S>> row;
        for (auto k = std::size_t(offsets_[std::size_t(r)]); k < std::size_t(offsets_[std::size_t(r) + 1]); ++k) {
            row.push_back({columns_[k], values_[k]});
        }
        std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.column < b.column; });
        for (std::size_t k = 0; k < row.size(); ++k) {
            require(row[k].column >= 0 && row[k].column < num_columns(), source_, "_indices: row ", r, " has column ",
                    row[k].column, ", expected 0 to ", num_columns() - 1);
            require(k == 0 || row[k].column != row[k - 1].column, source_, "_indices: row ", r, " has column ",
                    row[k].column, " twice");
        }
        return row;
    }

    /// Adds an entry; rows and the columns within a row must come in ascending order.
    void append(Index row, Index column, S value) {
        columns_.push_back(static_cast<std::int32_t>(column));
        values_.push_back(value);
        offsets_[std::size_t(row) + 1] = Index(values_.size());
    }

    /// Puts the four parts into `arrays`.
    void store(NpyArrays& arrays, const std::string& name) const {
        const auto vector = [](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            return NpyArray::from_values(std::span<const T>(values), {Index(values.size())});
        };
        arrays[name + "_data"] = vector(values_);
        arrays[name + "_indices"] = vector(columns_);
        std::vector<Index> offsets = offsets_;  // rows without entries end where the one before ends
        std::inclusive_scan(offsets.begin(), offsets.end(), offsets.begin(),
                            [](Index a, Index b) { return std::max(a, b); });
        arrays[name + "_indptr"] = vector(offsets);
        arrays[name + "_shape"] = vector(shape_);
    }

private:
    static const NpyArray& part(const NpzFile& file, const std::string& name, const char* suffix) {
        require(file.contains(name + suffix), file.path(), ": array '", name, "' is missing, neither dense nor as ",
                name, "_{data,indices,indptr,shape}");
        const NpyArray& array = file.at(name + suffix);
        array.require_shape({NpyArray::any});
        return array;
    }

    Index num_columns() const {
        Index columns = 1;
        for (std::size_t d = 1; d < shape_.size(); ++d) {
            columns *= shape_[d];
        }
        return columns;
    }

    std::string source_;
    std::vector<Index> shape_;
    std::vector<S> values_;
    std::vector<std::int32_t> columns_;
    std::vector<Index> offsets_;
};

/// Fills the empty sparse `matrix` with the non-zeros of a dense array of as many elements, row after row.
template <class SparseMatrix>
void append_dense_rows(const NpyArray& array, SparseMatrix& matrix) {
    using S = typename SparseMatrix::Scalar;
    const Index columns = matrix.cols();
    array.for_each<S>([&](Index i, S value) {
        if (i % columns == 0) {
            matrix.startVec(i / columns);
        }
        if (value != S(0)) {
            matrix.insertBack(i / columns, i % columns) = value;
        }
    });
    matrix.finalize();
}

}  // namespace softtissue
