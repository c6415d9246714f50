// SPDX-License-Identifier: MIT
#include <softtissue/ndg/evaluation.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/rest_operators.hpp>

#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("the figures of a pose are those of the metrics", S, float, double) {
    const LayeredLimb<S> limb;
    const auto operators = RestOperators<Prism6, S>::at(limb.body.mesh, limb.body.mesh.rest_positions);
    const PrescribedVertices prescribed(limb.body.mesh.num_vertices(), limb.body.prescribed);
    const Matrix3X<S> reference = limb.bent(0.9), x = limb.bent(1.0);
    const PoseFigures<S> figures = measure_pose(limb.body.mesh, operators, prescribed, x, reference);
    const PositionError<S> position = position_error(x, reference, prescribed);
    const VolumeChange<S> volume = volume_change(limb.body.mesh, x);
    CHECK(figures.position == position.mean);
    CHECK(figures.position > S(1e-4));
    CHECK(figures.largest_position == position.largest);
    CHECK(figures.gradient == gradient_error(limb.body.mesh, operators, x, reference));
    CHECK(figures.gradient > S(0));
    CHECK(figures.volume == volume.mean_square);
    CHECK(figures.inverted == volume.num_inverted);

    const PoseFigures<S> same = measure_pose(limb.body.mesh, operators, prescribed, x, x);
    CHECK(same.position == S(0));
    CHECK(same.gradient == S(0));
    CHECK(same.volume == figures.volume);

    const PoseFigures<S> alone = measure_pose(limb.body.mesh, x);
    CHECK(alone.volume == figures.volume);
    CHECK(alone.position == S(0));

    Matrix3X<S> mirrored = limb.body.mesh.rest_positions;
    mirrored.row(0) *= S(-1);
    CHECK(measure_pose(limb.body.mesh, mirrored).inverted == limb.body.mesh.num_cells());
}

TEST_CASE("mean, standard error and worst over the poses") {
    MethodEvaluation<double> method;
    CHECK(method.summary(&PoseFigures<double>::position).mean == 0.0);
    CHECK(method.summary(&PoseFigures<double>::position).worst_pose == -1);
    method.add({.position = 2.0, .inverted = 1});
    CHECK(method.summary(&PoseFigures<double>::position).standard_error == 0.0);
    method.add({.position = 7.0, .inverted = 0});
    method.add({.position = 3.0, .inverted = 0});
    const FigureSummary position = method.summary(&PoseFigures<double>::position);
    CHECK(position.mean == doctest::Approx(4.0));
    CHECK(position.standard_error == doctest::Approx(std::sqrt((4.0 + 9.0 + 1.0) / 6.0)));
    CHECK(position.worst == 7.0);
    CHECK(position.worst_pose == 1);
    CHECK(method.summary(&PoseFigures<double>::inverted).mean == doctest::Approx(1.0 / 3.0));

    method.add({.position = std::numeric_limits<double>::quiet_NaN()});
    method.add({.position = 9.0});
    CHECK(std::isnan(method.summary(&PoseFigures<double>::position).mean));
    CHECK(std::isnan(method.summary(&PoseFigures<double>::position).worst));
    CHECK(method.summary(&PoseFigures<double>::position).worst_pose == 3);
}

TEST_CASE("two methods are compared pose by pose") {
    MethodEvaluation<float> a, b;
    for (const float shared : {1.0F, 5.0F, 9.0F}) {  // hard and easy poses hide what both have in common
        a.add({.gradient = shared + 0.5F});
        b.add({.gradient = shared});
    }
    const FigureSummary more = difference(a, b, &PoseFigures<float>::gradient);
    CHECK(more.mean == doctest::Approx(0.5));
    CHECK(more.standard_error == doctest::Approx(0.0));
    b.add({});
    CHECK_THROWS_WITH_AS(difference(a, b, &PoseFigures<float>::gradient),
                         "difference of methods: 3 and 4 poses, expected equal numbers", InvalidInput);
}

TEST_CASE_TEMPLATE("errors of the vertices, averaged over the poses", S, float, double) {
    Matrix3X<S> reference = Matrix3X<S>::Zero(3, 2), x = reference;
    x.col(1) << S(3), S(4), S(0);
    const VectorX<S> errors = vertex_errors(x, reference);
    CHECK(errors(0) == S(0));
    CHECK(errors(1) == S(5));
    MethodEvaluation<S> method;
    CHECK(method.mean_vertex_errors().size() == 0);
    method.add({}, errors);
    method.add({}, VectorX<S>::Ones(2));
    CHECK(method.num_poses() == 2);
    CHECK(method.mean_vertex_errors()(0) == S(0.5));
    CHECK(method.mean_vertex_errors()(1) == S(3));
    CHECK_THROWS_WITH_AS(method.add({}, VectorX<S>::Ones(3)),
                         "method evaluation: 3 vertex errors, expected 2 as in the first pose", InvalidInput);
    CHECK_THROWS_WITH_AS(vertex_errors<S>(x, Matrix3X<S>::Zero(3, 5)),
                         "vertex errors: 2 positions and 5 reference positions, expected equal numbers", InvalidInput);
}
