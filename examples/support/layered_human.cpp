// SPDX-License-Identifier: MIT
#include "layered_human.hpp"

#include <softtissue/anatomy/make_layered_body.hpp>

namespace examples {

using namespace softtissue;

BodyFunction layered_bodies(const SmplBody<double>& body) {
    return ShapedBodyMaker<double>(body);
}

LayeredBody<double> layered_body_of(const SmplBody<double>& body) {
    return make_layered_body(body);
}

}  // namespace examples
