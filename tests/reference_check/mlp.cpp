// SPDX-License-Identifier: MIT
// Networks that predict deformation gradients: matrix exponential, perceptron, training.
#include "reference_case.hpp"

#include <softtissue/linalg/matrix_exponential.hpp>
#include <softtissue/linalg/matrix_exponentials.hpp>
#include <softtissue/nn/adamw.hpp>
#include <softtissue/nn/mlp.hpp>
#if __has_include(<nlohmann/json.hpp>)
#include <softtissue/io/network_file.hpp>
#define SOFTTISSUE_READS_NETWORKS
#endif

#include <algorithm>
#include <string>
#include <vector>

namespace reference_check {
namespace {

using namespace softtissue;

/// An array of any shape as columns of `rows` numbers in C order: samples as columns, or 3x3 matrices row after row.
template <class S>
MatrixX<S> columns(const ReferenceCase& reference, const std::string& array, Index rows) {
    const VectorX<S> values = reference.flat(array.c_str()).cast<S>();
    return Eigen::Map<const MatrixX<S>>(values.data(), rows, values.size() / rows);
}

/// The sizes of the network whose weights are `prefix` + "0.weight", "3.weight", ...
MlpSizes sizes_of(const ReferenceCase& reference, const std::string& prefix) {
    MlpSizes sizes;
    for (int module = 0; reference.has((prefix + std::to_string(module) + ".weight").c_str()); module += 3) {
        const std::vector<Index>& shape = reference.file.at(prefix + std::to_string(module) + ".weight").shape();
        (module == 0 ? sizes.inputs : sizes.hidden.emplace_back()) = shape[1];
        sizes.outputs = shape[0];
    }
    return sizes;
}

/// The arrays `prefix` + tensor name in the order of the network's parameters.
VectorX<double> parameters(const ReferenceCase& reference, const std::string& prefix,
                           const std::vector<ParameterTensor>& tensors) {
    VectorX<double> result(tensors.back().offset + tensors.back().size());
    for (const ParameterTensor& tensor : tensors) {
        result.segment(tensor.offset, tensor.size()) = reference.flat((prefix + tensor.name).c_str());
    }
    return result;
}

/// The largest relative_difference() of any one tensor.
double tensor_difference(const VectorX<double>& a, const VectorX<double>& b,
                         const std::vector<ParameterTensor>& tensors) {
    double worst = 0;
    for (const ParameterTensor& tensor : tensors) {
        worst = std::max(worst, relative_difference(a.segment(tensor.offset, tensor.size()),
                                                    b.segment(tensor.offset, tensor.size())));
    }
    return worst;
}

/// A perceptron whose outputs are logarithms of deformation gradients.
template <class S>
struct Predictor {
    Mlp<S> network;
    typename Mlp<S>::Tape tape;
    MatrixX<S> logarithms, gradients;

    Predictor(const ReferenceCase& reference, const std::string& prefix, Index max_batch)
        : network(sizes_of(reference, prefix)), tape(network.make_tape(max_batch)) {
        network.parameters() = parameters(reference, prefix, network.tensors()).template cast<S>();
    }

    /// exp of the outputs, outputs x batch.
    MatrixX<S> predict(const MatrixX<S>& x) {
        logarithms.resize(network.sizes().outputs, x.cols());
        network.forward_into(x, tape, logarithms);
        MatrixX<S> F(logarithms.rows(), logarithms.cols());
        matrix_exponentials_into<S>(matrices(logarithms), matrices(F));
        return F;
    }

    /// After predict(): the gradient by the parameters of a function whose gradient by F is given.
    VectorX<S> pull_back(const MatrixX<S>& x, const MatrixX<S>& F_gradients) {
        gradients = F_gradients;
        matrix_exponential_pullbacks_into<S>(matrices(logarithms), matrices(gradients), matrices(gradients));
        VectorX<S> result;
        network.backward_into(x, tape, gradients, result);
        return result;
    }

    static Eigen::Map<Matrix9X<S>> matrices(MatrixX<S>& columns) { return {columns.data(), 9, columns.size() / 9}; }
};

template <class S>
void check_perceptron(const ReferenceCase& reference, Checklist& checks, double tolerance) {
    Predictor<S> predictor(reference, "w.net.", reference.file.at("x").shape()[0]);
    const MlpSizes& sizes = predictor.network.sizes();
    const MatrixX<S> x = columns<S>(reference, "x", sizes.inputs);
    const MatrixX<S> F = predictor.predict(x);
    for (size_t k = 0; k < sizes.hidden.size(); ++k) {
        const std::string name = "act." + std::to_string(3 * k + 2);
        checks.add(reference.name, ("hidden layer " + std::to_string(k)).c_str(),
                   relative_difference(predictor.tape.hidden[k].outputs, columns<S>(reference, name, sizes.hidden[k])),
                   tolerance);
    }
    const std::string last = "act." + std::to_string(3 * sizes.hidden.size());
    checks.add(reference.name, "outputs",
               relative_difference(predictor.logarithms, columns<S>(reference, last, sizes.outputs)), tolerance);
    MatrixX<S> inferred(sizes.outputs, x.cols());
    auto scratch = predictor.network.make_scratch(x.cols());
    predictor.network.infer_into(x, scratch, inferred);
    checks.add(reference.name, "outputs by inference",
               relative_difference(inferred, columns<S>(reference, last, sizes.outputs)), tolerance);
    checks.add(reference.name, "deformation gradients",
               relative_difference(F, columns<S>(reference, "y", sizes.outputs)), tolerance);
    const VectorX<S> gradient = predictor.pull_back(x, columns<S>(reference, "cotangent", sizes.outputs));
    const std::vector<ParameterTensor>& tensors = predictor.network.tensors();
    checks.add(reference.name, "gradient by parameters, each tensor",
               tensor_difference(gradient.template cast<double>(), parameters(reference, "g.net.", tensors), tensors),
               tolerance);
    MatrixX<S> input_gradients(sizes.inputs, x.cols());
    predictor.network.input_gradients_into(predictor.tape, predictor.gradients, input_gradients);
    checks.add(reference.name, "gradient by inputs",
               relative_difference(input_gradients, columns<S>(reference, "g_x", sizes.inputs)), tolerance);
#ifdef SOFTTISSUE_READS_NETWORKS
    std::filesystem::path stored = reference.file.path();
    const Mlp<S> read = load_network<S>(read_safetensors(stored.replace_extension(".safetensors")), "net.");
    checks.add(reference.name, "parameters from .safetensors",
               relative_difference(read.parameters(), predictor.network.parameters()), 0);
#endif
}

}  // namespace

void check_matrix_exponential(const ReferenceCase& reference, Checklist& checks) {
    const MatrixX<double> A = columns<double>(reference, "A", 9), G = columns<double>(reference, "G", 9);
    const MatrixX<double> exact = columns<double>(reference, "expA", 9), vjp = columns<double>(reference, "vjp", 9);
    MatrixX<double> X(9, A.cols()), L(9, A.cols());
    matrix_exponentials_into<double>(A, X);
    matrix_exponential_pullbacks_into<double>(A, G, L);
    double value = 0, gradient = 0, one = 0;
    for (Index c = 0; c < A.cols(); ++c) {
        value = std::max(value, relative_difference(X.col(c), exact.col(c)));
        gradient = std::max(gradient, relative_difference(L.col(c), vjp.col(c)));
        one = std::max(one, relative_difference(vec(matrix_exponential(unvec<double>(A.col(c)))), exact.col(c)));
    }
    checks.add(reference.name, "exponential", one, 1e-14);
    checks.add(reference.name, "exponentials", value, 1e-14);
    checks.add(reference.name, "gradient", gradient, 1e-14);
}

void check_mlp(const ReferenceCase& reference, Checklist& checks) {
    if (reference.name.ends_with("f32")) {
        check_perceptron<float>(reference, checks, 1e-5);
    } else {
        check_perceptron<double>(reference, checks, 1e-12);
    }
}

void check_training(const ReferenceCase& reference, Checklist& checks) {
    const MatrixX<double> order = reference.file.at("order").matrix<double>();
    Predictor<double> predictor(reference, "w0.net.", reference.file.at("X").shape()[0]);
    Mlp<double>& network = predictor.network;
    const MatrixX<double> X = columns<double>(reference, "X", network.sizes().inputs);
    const MatrixX<double> Y = columns<double>(reference, "Y", network.sizes().outputs);
    const VectorX<double> losses = reference.flat("losses");
    const AdamWOptions options{.learning_rate = reference.scalar("lr"),
                               .beta1 = reference.scalar("beta1"),
                               .beta2 = reference.scalar("beta2"),
                               .epsilon = reference.scalar("eps"),
                               .weight_decay = reference.scalar("weight_decay")};
    VectorX<double> first = VectorX<double>::Zero(network.parameters().size()), second = first;
    double loss_error = 0;
    for (Index step = 0; step < order.rows(); ++step) {
        MatrixX<double> x(X.rows(), order.cols()), y(Y.rows(), order.cols());
        for (Index sample = 0; sample < order.cols(); ++sample) {
            x.col(sample) = X.col(Index(order(step, sample)));
            y.col(sample) = Y.col(Index(order(step, sample)));
        }
        const MatrixX<double> difference = predictor.predict(x) - y;
        const double loss = difference.squaredNorm() / double(difference.size());
        loss_error = std::max(loss_error, std::abs(loss / losses(step) - 1));
        const VectorX<double> gradient = predictor.pull_back(x, 2 / double(difference.size()) * difference);
        if (step == 0) {
            checks.add(
                reference.name, "first gradient, each tensor",
                tensor_difference(gradient, parameters(reference, "g0.net.", network.tensors()), network.tensors()),
                1e-11);
        }
        adamw_update(options, options.learning_rate, step + 1, gradient, first, second, network.parameters());
    }
    checks.add(reference.name, "losses of all steps", loss_error, 1e-9);
    checks.add(
        reference.name, "parameters after all steps",
        tensor_difference(network.parameters(), parameters(reference, "w1.net.", network.tensors()), network.tensors()),
        1e-9);
    const MatrixX<double> difference = predictor.predict(X) - Y;
    checks.add(reference.name, "loss over all samples after them",
               std::abs(difference.squaredNorm() / double(difference.size()) / reference.scalar("full_loss_after") - 1),
               1e-9);
}

}  // namespace reference_check
