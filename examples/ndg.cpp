// SPDX-License-Identifier: MIT
// ctest: generate --samples 10 --bodies 5 --outlier-samples 0 --limit 1 --out ndg_test
//
// Neural deformation gradients from end to end: training data by the quasi-static reference, training, evaluation,
// animation (Nolte et al. 2026). Each subcommand has its own source in ndg/.
#include "ndg/generate.hpp"
#include "ndg/train.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    CLI::App app("Neural deformation gradients: makes training data, trains, evaluates and animates.");
    app.require_subcommand(1);
    try {
        examples::add_generate(app);
        examples::add_train(app);
        CLI11_PARSE(app, argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "ndg: %s\n", error.what());
        return 1;
    }
    return 0;
}
