// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_array.hpp>

#include <softtissue/core/dual.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("items come back from their lanes, the last one repeated", S, float, double) {
    using Array = PackArray<S, 7>;
    for (const Index count : {Index(1), Index(5), Index(Array::width), Index(2 * Array::width + 1)}) {
        Array array(count);
        CHECK(array.num_items() == count);
        CHECK(array.num_packs() == (count + Array::width - 1) / Array::width);
        const auto number = [](Index item, int k) { return S(100 * item + k); };
        for (Index item = 0; item < count; ++item) {
            Eigen::Matrix<S, 3, 2> numbers;
            for (int k = 0; k < 6; ++k) {
                numbers.data()[k] = number(item, k + 1);
            }
            array.set(item, 1, numbers);
            array.set(item, 0, number(item, 0));
        }
        bool all_same = true;
        for (Index pack = 0; pack < array.num_packs(); ++pack) {
            for (int i = 0; i < Array::width; ++i) {
                const Index item = array.item(pack, i);
                all_same = all_same && item == std::min(Array::width * pack + i, count - 1);
                const auto M = array.template packed_matrix_at<3, 2>(pack, 1);
                const Eigen::Matrix<S, 3, 2> plain = array.template matrix_at<Eigen::Matrix<S, 3, 2>>(item, 1);
                for (int k = 0; k < 7; ++k) {
                    all_same =
                        all_same && array.at(item, k) == number(item, k) &&
                        array.pack_at(pack, k)[i] == number(item, k) &&
                        (k == 0 || (M.data()[k - 1][i] == number(item, k) && plain.data()[k - 1] == number(item, k)));
                }
            }
        }
        CHECK(all_same);
    }
}

TEST_CASE("numbers with derivatives stand alone") {
    using D = Dual<double, 1>;
    PackArray<D, 2> array(3);
    CHECK(PackArray<D, 2>::width == 1);
    array.set(2, 1, D(5));
    CHECK(value_of(array.at(2, 1)) == 5.0);
    CHECK(PackArray<double, 2>().num_packs() == 0);
}
