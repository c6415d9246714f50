// SPDX-License-Identifier: MIT
#include <softtissue/nn/learning_rate.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("constant unless told otherwise") {
    for (const Index step : {0, 5, 99}) {
        CHECK(LearningRateSchedule{}.factor(step, 100) == 1);
    }
}

TEST_CASE("a straight line up, then half a cosine down") {
    const LearningRateSchedule schedule{.warm_up_steps = 20, .final_fraction = 0.02};
    CHECK(schedule.factor(0, 120) == doctest::Approx(0.05));
    CHECK(schedule.factor(9, 120) == doctest::Approx(0.5));
    CHECK(schedule.factor(19, 120) == 1);
    CHECK(schedule.factor(20, 120) == 1);
    CHECK(schedule.factor(70, 120) == doctest::Approx(0.51));
    CHECK(schedule.factor(119, 120) == doctest::Approx(0.02).epsilon(0.02));
    CHECK(schedule.factor(119, 120) > 0.02);
    for (Index step = 20; step < 119; ++step) {
        CHECK(schedule.factor(step + 1, 120) < schedule.factor(step, 120));
    }
}

TEST_CASE("a training that ends while it warms up") {
    CHECK(LearningRateSchedule{.warm_up_steps = 10}.factor(4, 5) == doctest::Approx(0.5));
}

TEST_CASE("negative numbers are refused") {
    CHECK_THROWS_WITH_AS(LearningRateSchedule{.warm_up_steps = -1}.validate(),
                         "learning rate: warm_up_steps = -1, expected >= 0", InvalidInput);
    CHECK_THROWS_AS(LearningRateSchedule{.final_fraction = -0.1}.validate(), InvalidInput);
    CHECK_NOTHROW(LearningRateSchedule{.warm_up_steps = 3, .final_fraction = 0}.validate());
}
