// SPDX-License-Identifier: MIT
// ctest: generate --samples 5 --bodies 5 --outlier-samples 1 --outlier-bodies 1 --out ndg_test
// ctest: train --data ndg_test --model ndg-pca --epochs 2 --out ndg_test/model.safetensors
// ctest: evaluate --data ndg_test --models ndg_test/model.safetensors --methods gradient,lbs --out ndg_test/evaluation
// ctest: animate --model ndg_test/model.safetensors --frames 3 --shots 2 --out ndg_test/animation.glb
//
// Neural deformation gradients from end to end: training data by the quasi-static reference, training, evaluation,
// animation (Nolte et al. 2026). Each subcommand has its own source in ndg/.
#include "ndg/animate.hpp"
#include "ndg/evaluate.hpp"
#include "ndg/generate.hpp"
#include "ndg/train.hpp"
#include "support/guarded.hpp"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
    CLI::App app("Neural deformation gradients: makes training data, trains, evaluates and animates.");
    app.require_subcommand(1);
    return examples::guarded("ndg", [&] {
        examples::add_generate(app);
        examples::add_train(app);
        examples::add_evaluate(app);
        examples::add_animate(app);
        CLI11_PARSE(app, argc, argv);
        return 0;
    });
}
