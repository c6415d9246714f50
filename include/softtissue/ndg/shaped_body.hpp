// SPDX-License-Identifier: MIT
/// @file
/// The layered body of a shape.
///
/// What        ShapedBody: layers and rest joints; ShapedBodyMaker: makes them for shape coefficients of an SMPL body.
/// Contract    all shapes of one maker have the same cells, weights and prescribed vertices.
/// Refuses     shapes for which no layered body exists (InvalidInput, see anatomy/make_layered_body.hpp)
/// Cost        that of make_layered_body(): seconds
/// Tests       tests/unit/ndg/shaped_body_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/anatomy/make_layered_body.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <utility>

namespace softtissue {

template <RealScalar S>
struct ShapedBody {
    using Scalar = S;

    LayeredBody<Scalar> layered;
    Matrix3X<Scalar> joints;  // at rest, 3 x num_joints [m]
};

template <RealScalar S>
class ShapedBodyMaker {
public:
    using Scalar = S;

    explicit ShapedBodyMaker(SmplBody<Scalar> body, LayeredBodyOptions<Scalar> options = {})
        : body_(std::move(body)), shapes_(body_), options_(std::move(options)) {}

    const SmplBody<Scalar>& body() const { return body_; }

    /// Missing coefficients are zero.
    ShapedBody<Scalar> operator()(const VectorX<Scalar>& betas) const {
        const Matrix3X<Scalar> joints = shapes_.joints(betas);
        return {make_layered_body(shapes_.rest_shape(betas), body_.faces, body_.weights, body_.tree, joints, options_),
                joints};
    }

private:
    SmplBody<Scalar> body_;
    VolumetricSmpl<Scalar> shapes_;
    LayeredBodyOptions<Scalar> options_;
};

}  // namespace softtissue
