#include <softtissue/softtissue.hpp>

#include "every_header.hpp"

softtissue::Vector9<double> stacked_identity();

int main() { return stacked_identity() == softtissue::vec<double>(softtissue::Matrix3<double>::Identity()) ? 0 : 1; }
