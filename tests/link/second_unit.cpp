#include <softtissue/softtissue.hpp>

#include "every_header.hpp"

softtissue::Vector9<double> stacked_identity();

softtissue::Vector9<double> stacked_identity() {
    return softtissue::vec<double>(softtissue::Matrix3<double>::Identity());
}
