// An energy for double alone cannot be differentiated automatically; the error says what is needed.
// expect: FromEnergy needs a type with the member
#include <softtissue/material/from_energy.hpp>

struct DoubleOnly {
    double energy_density(const Eigen::Matrix<double, 3, 3>& F) const { return F.squaredNorm(); }
};

double use(const softtissue::FromEnergy<DoubleOnly>& material) {
    return material.energy_density(softtissue::Matrix3<double>::Identity());
}
