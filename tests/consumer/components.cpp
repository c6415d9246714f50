// The optional components: their headers are found and their libraries link.
#include <softtissue/io/npz.hpp>
#include <softtissue/sparse/cholmod.hpp>

#include <filesystem>

int main() {
    const char* const file = "components.npz";
    softtissue::write_npz(file, {{"x", softtissue::NpyArray::from_columns(softtissue::Matrix3X<double>::Ones(3, 2))}});
    const bool same = softtissue::read_npz(file).at("x").columns3<double>() == softtissue::Matrix3X<double>::Ones(3, 2);
    std::filesystem::remove(file);

    Eigen::SparseMatrix<double> identity(3, 3);
    identity.setIdentity();
    softtissue::CholmodCholesky cholesky;
    cholesky.compute(identity);
    return same && cholesky.info() == Eigen::Success ? 0 : 1;
}
