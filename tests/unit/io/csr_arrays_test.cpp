// SPDX-License-Identifier: MIT
#include <softtissue/io/csr_arrays.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

template <class T>
NpyArray vector_array(const std::vector<T>& values) {
    return NpyArray::from_values(std::span<const T>(values), {Index(values.size())});
}

/// [[0, 5, 0, 7], [0, 0, 0, 0], [8, 0, 0, 0]], its first row stored backwards.
NpyArrays sample_parts() {
    NpyArrays arrays;
    arrays["m_data"] = vector_array(std::vector<float>{7, 5, 8});
    arrays["m_indices"] = vector_array(std::vector<std::int32_t>{3, 1, 0});
    arrays["m_indptr"] = vector_array(std::vector<std::int32_t>{0, 2, 2, 3});
    arrays["m_shape"] = vector_array(std::vector<std::int64_t>{3, 4});
    return arrays;
}

CsrArrays<double> read(const NpyArrays& arrays, const std::vector<Index>& shape = {3, 4}) {
    return {NpzFile("a.npz", arrays), "m", shape};
}

/// The text of the refusal after one part was replaced.
std::string refused_with(const std::string& part, const NpyArray& replacement) {
    NpyArrays arrays = sample_parts();
    arrays[part] = replacement;
    return refusal([&] {
        const CsrArrays<double> rows = read(arrays);
        for (Index r = 0; r < 3; ++r) {
            static_cast<void>(rows.sorted_row(r));
        }
    });
}

}  // namespace

TEST_CASE("rows are read with ascending columns") {
    const CsrArrays<double> rows = read(sample_parts());
    const std::vector<CsrEntry<double>> first = rows.sorted_row(0);
    REQUIRE(first.size() == 2);
    CHECK(first[0].column == 1);
    CHECK(first[0].value == 5.0);
    CHECK(first[1].column == 3);
    CHECK(rows.sorted_row(1).empty());
    CHECK(rows.sorted_row(2)[0].value == 8.0);
}

TEST_CASE_TEMPLATE("what is stored is read again, rows without entries included", S, float, double) {
    CsrArrays<S> rows({4, 2, 3});
    rows.append(1, 0, S(2));
    rows.append(1, 5, S(3));
    rows.append(2, 4, S(4));
    NpyArrays arrays;
    rows.store(arrays, "m");
    const CsrArrays<S> again(NpzFile("a.npz", arrays), "m", {4, 2, 3});
    CHECK(again.sorted_row(0).empty());
    CHECK(again.sorted_row(1).size() == 2);
    CHECK(again.sorted_row(1)[1].column == 5);
    CHECK(again.sorted_row(2)[0].value == S(4));
    CHECK(again.sorted_row(3).empty());
}

TEST_CASE("parts that do not fit together are refused") {
    CHECK(contains(refusal([] { static_cast<void>(read({})); }),
                   "a.npz: array 'm' is missing, neither dense nor as m_{data,indices,indptr,shape}"));
    CHECK(contains(refusal([] { static_cast<void>(read(sample_parts(), {4, 4})); }), "not the shape expected"));
    CHECK(contains(refused_with("m_data", vector_array(std::vector<float>{7, 5})),
                   "a.npz: m_indices has 3 entries, expected 2"));
    CHECK(
        contains(refused_with("m_indptr", vector_array(std::vector<int>{0, 3})), "expected one more than the 3 rows"));
    for (const std::vector<int>& offsets : {std::vector<int>{0, 2, 1, 3}, {1, 2, 2, 3}, {0, 2, 2, 9}, {0, -2, 2, 3}}) {
        CHECK(contains(refused_with("m_indptr", vector_array(offsets)),
                       "m_indptr does not ascend from 0 to the 3 entries"));
    }
    CHECK(contains(refused_with("m_indices", vector_array(std::vector<int>{3, 4, 0})),
                   "m_indices: row 0 has column 4, expected 0 to 3"));
    CHECK(contains(refused_with("m_indices", vector_array(std::vector<int>{3, -1, 0})), "row 0 has column -1"));
    CHECK(contains(refused_with("m_indices", vector_array(std::vector<int>{3, 3, 0})), "row 0 has column 3 twice"));
    CHECK(contains(refused_with("m_data", NpyArray::from_scalar(1.0)), "expected (any,)"));
}

TEST_CASE("the non-zeros of a dense array fill a sparse matrix") {
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(3, 2);
    append_dense_rows(NpyArray::from_matrix((MatrixX<double>(3, 2) << 0, 1, 0, 0, 2, 0).finished()), matrix);
    CHECK(matrix.nonZeros() == 2);
    CHECK(matrix.coeff(0, 1) == 1.0);
    CHECK(matrix.coeff(2, 0) == 2.0);
}
