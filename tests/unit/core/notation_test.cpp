#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <type_traits>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(std::is_same_v<Triangles::Scalar, std::int32_t> && Triangles::RowsAtCompileTime == 3);
static_assert(Connectivity<6>::RowsAtCompileTime == 6 && Connectivity<6>::ColsAtCompileTime == Eigen::Dynamic);
static_assert(!bool(Matrix3X<double>::IsRowMajor), "positions are xyz xyz xyz in memory");

namespace {

template <class Scalar>
const Scalar* bound_data(ConstRef<Matrix3X<Scalar>> x) {
    return x.data();
}

}  // namespace

TEST_CASE_TEMPLATE("vec() stacks columns: entry (i, j) of F is entry i + 3 j", Scalar, float, double) {
    Matrix3<Scalar> F;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            F(i, j) = Scalar(10 * i + j);
        }
    }
    const Vector9<Scalar> f = vec(F);
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            CHECK(f(i + 3 * j) == F(i, j));
        }
    }
    CHECK(unvec(f) == F);
}

TEST_CASE_TEMPLATE("dof 3 v + d of positions is component d of vertex v", Scalar, float, double) {
    Matrix3X<Scalar> x(3, 2);
    x << Scalar(1), Scalar(4), Scalar(2), Scalar(5), Scalar(3), Scalar(6);
    for (Index v = 0; v < 2; ++v) {
        for (Index d = 0; d < 3; ++d) {
            CHECK(x.data()[3 * v + d] == x(d, v));
        }
    }
}

TEST_CASE_TEMPLATE("ConstRef binds as its comment says", Scalar, float, double) {
    using RowMajorNx3 = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
    using ColumnMajorNx3 = Eigen::Matrix<Scalar, Eigen::Dynamic, 3>;

    const Matrix3X<Scalar> x = Matrix3X<Scalar>::Constant(3, 5, Scalar(2));
    CHECK(bound_data<Scalar>(x) == x.data());
    CHECK(bound_data<Scalar>(x.leftCols(2)) == x.data());

    const MatrixX<Scalar> dynamic = MatrixX<Scalar>::Constant(3, 5, Scalar(2));
    CHECK(bound_data<Scalar>(dynamic) == dynamic.data());

    const RowMajorNx3 numpy_order = RowMajorNx3::Constant(5, 3, Scalar(2));
    CHECK(bound_data<Scalar>(numpy_order.transpose()) == numpy_order.data());

    const ColumnMajorNx3 copied = ColumnMajorNx3::Constant(5, 3, Scalar(2));
    CHECK(bound_data<Scalar>(copied.transpose()) != copied.data());
}
