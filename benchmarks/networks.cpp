// SPDX-License-Identifier: MIT
// Networks that predict deformation gradients: a training step beside its matrix products alone, inference at the paper's
// size with weights in each format, activations beside those by std::erf.

#include "machine_limits.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/nn/adamw.hpp>
#include <softtissue/nn/gelu.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

namespace {

using namespace softtissue;

/// What a small experiment trains: 23 joints and 10 shape coefficients to 14,992 prisms.
const MlpSizes small_body{217, {384, 384, 96}, 134928};
/// 60 joints and 300 shape coefficients to 53,000 prisms; 309 million weights.
const MlpSizes paper_body{840, {4096, 4096, 600}, 477000};

MatrixX<float> random_columns(Index rows, Index columns) {
    RandomGenerator random(1);
    return MatrixX<float>::NullaryExpr(rows, columns, [&] { return float(random.uniform(-1, 1)); });
}

double num_weights(const MlpSizes& sizes) {
    double count = 0, width = double(sizes.inputs);
    for (const Index hidden : sizes.hidden) {
        count += width * double(hidden);
        width = double(hidden);
    }
    return count + width * double(sizes.outputs);
}

void count_training(benchmark::State& state, Index batch, int threads) {
    benchmarks::count_work<float>(state, {.unit = "samples",
                                          .items = double(batch),
                                          .flops = 6 * num_weights(small_body) * double(batch),
                                          .threads = threads});
}

/// Value, gradient and update: 6 flop a weight and sample. Arguments: batch, threads.
void training_step(benchmark::State& state) {
    const Index batch = state.range(0);
    const ThreadExecutor executor(int(state.range(1)));
    Mlp<float> network(small_body);
    network.initialize(1);
    auto tape = network.make_tape(batch);
    const MatrixX<float> x = random_columns(small_body.inputs, batch), dy = random_columns(small_body.outputs, batch);
    MatrixX<float> y(small_body.outputs, batch);
    VectorX<float> gradient, first = VectorX<float>::Zero(network.parameters().size()), second = first;
    Index step = 0;
    for (auto _ : state) {
        network.forward_into(x, tape, y, executor);
        network.backward_into(x, tape, dy, gradient, executor);
        adamw_update({}, 1e-6, ++step, gradient, first, second, network.parameters(), executor);
        benchmark::ClobberMemory();
    }
    count_training(state, batch, executor.num_threads());
}

/// The three matrix products of each layer by Eigen, and nothing else.
void products_of_a_training_step(benchmark::State& state) {
    const Index batch = state.range(0);
    Mlp<float> network(small_body);
    network.initialize(1);
    Mlp<float> gradient = network;
    for (auto _ : state) {
        Index width = small_body.inputs;
        for (Index k = 0; k <= network.layers().num_hidden(); ++k) {
            state.PauseTiming();
            const MatrixX<float> x = random_columns(width, batch);
            width = network.weight(k).rows();
            const MatrixX<float> dy = random_columns(width, batch);
            MatrixX<float> y(width, batch), dx(x.rows(), batch);
            state.ResumeTiming();
            y.noalias() = network.weight(k) * x;
            gradient.weight(k).noalias() = dy * x.transpose();
            dx.noalias() = network.weight(k).transpose() * dy;
            benchmark::DoNotOptimize(y.data());
            benchmark::DoNotOptimize(dx.data());
            benchmark::ClobberMemory();
        }
    }
    count_training(state, batch, 1);
}

void adamw_step(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const Index size = Index(num_weights(small_body));
    VectorX<float> p = VectorX<float>::Ones(size), m = p, v = p, g = p;
    Index step = 0;
    for (auto _ : state) {
        adamw_update({}, 1e-6, ++step, g, m, v, p, executor);
        benchmark::ClobberMemory();
    }
    const double bytes = 4 * double(size);
    benchmarks::count_work<float>(state, {.unit = "parameters",
                                          .items = double(size),
                                          .bytes_read = 4 * bytes,
                                          .bytes_written = 3 * bytes,
                                          .threads = executor.num_threads()});
}

Mlp<float>& paper_network() {
    static Mlp<float> network = [] {
        Mlp<float> result(paper_body);
        result.initialize(1);
        return result;
    }();
    return network;
}

template <WeightFormat format>
const auto& network_of_format() {
    if constexpr (format == WeightFormat::full) {
        return paper_network();
    } else {
        static const QuantizedMlp<float> network(paper_network(), format, random_columns(paper_body.inputs, 200),
                                                 ThreadExecutor(2));
        return network;
    }
}

/// Argument: threads. Reading is measured on as many bytes of the weights in single precision.
template <WeightFormat format, int samples>
void inference_at_paper_size(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const auto& network = network_of_format<format>();
    auto scratch = network.make_scratch(samples);
    const MatrixX<float> x = random_columns(paper_body.inputs, samples);
    MatrixX<float> y(paper_body.outputs, samples);
    for (auto _ : state) {
        network.infer_into(x, scratch, y, executor);
        benchmark::DoNotOptimize(y.data());
        benchmark::ClobberMemory();
    }
    std::span<const float> weights(paper_network().parameters().data(), size_t(paper_network().parameters().size()));
    if constexpr (format != WeightFormat::full) {
        weights = weights.first(network.num_bytes() / sizeof(float));
    }
    const double flops = 2 * num_weights(paper_body) * samples;
    benchmarks::count_work<float>(state, {.unit = "samples",
                                          .items = samples,
                                          .flops = format == WeightFormat::full ? flops : 0,
                                          .bytes_read = double(weights.size_bytes()),
                                          .memory = std::as_bytes(weights),
                                          .threads = int(state.range(0))});
}

template <WeightFormat format, int samples>
void add_inference_at_paper_size(const std::string& variant) {
    const std::string group =
        samples == 1 ? "13 network of the paper's size, one sample/" : "13 network of the paper's size, four samples/";
    benchmark::RegisterBenchmark((group + variant).c_str(), inference_at_paper_size<format, samples>)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
}

template <int samples>
bool add_inference_at_paper_size() {
    add_inference_at_paper_size<WeightFormat::full, samples>("baseline full weights");
    add_inference_at_paper_size<WeightFormat::full, samples>("float");
    add_inference_at_paper_size<WeightFormat::bfloat16, samples>("bfloat16");
    add_inference_at_paper_size<WeightFormat::int8, samples>("int8");
    add_inference_at_paper_size<WeightFormat::int4, samples>("int4");
    return true;
}

template <class S, class A>
[[gnu::flatten]] void activate(const S* x, ActivationValue<S*> result, Index count) {
    for (Index i = 0; i < count; ++i) {
        const ActivationValue<S> activation = A::at(x[i]);
        result.value[i] = activation.value;
        result.slope[i] = activation.slope;
    }
}

template <class S, class A>
void activation(benchmark::State& state) {
    const VectorX<S> x = VectorX<S>::LinSpaced(4096, S(-4), S(4));
    VectorX<S> value(4096), slope(4096);
    for (auto _ : state) {
        activate<S, A>(x.data(), {value.data(), slope.data()}, 4096);
        benchmark::ClobberMemory();
    }
    benchmarks::count_work<S>(state, {.unit = "values", .items = 4096});
}

template <class S>
void naive_activation(benchmark::State& state) {
    VectorX<S> x = VectorX<S>::LinSpaced(4096, S(-4), S(4)), value(4096), slope(4096);
    for (auto _ : state) {
        for (Index i = 0; i < 4096; ++i) {
            const S cumulative = S(0.5) * (S(1) + std::erf(x(i) * S(0.70710678118654752440)));
            value(i) = x(i) * cumulative;
            slope(i) = cumulative + x(i) * S(0.39894228040143267794) * std::exp(S(-0.5) * x(i) * x(i));
        }
        benchmark::ClobberMemory();
    }
    benchmarks::count_work<S>(state, {.unit = "values", .items = 4096});
}

}  // namespace

BENCHMARK(training_step)
    ->Name("network, a training step of 14,992 prisms/float")
    ->ArgNames({"batch", "threads"})
    ->ArgsProduct({{16, 32}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(products_of_a_training_step)
    ->Name("network, a training step of 14,992 prisms/baseline Eigen's products alone, float")
    ->ArgName("batch")
    ->Arg(16)
    ->Arg(32)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(adamw_step)
    ->Name("network, a step of AdamW/float")
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond);
[[maybe_unused]] const bool is_inference_added = add_inference_at_paper_size<1>() && add_inference_at_paper_size<4>();
BENCHMARK(activation<float, Gelu>)->Name("GELU and slope/float");
BENCHMARK(activation<double, Gelu>)->Name("GELU and slope/double");
BENCHMARK(activation<float, TanhGelu>)->Name("GELU and slope/by tanh, float");
BENCHMARK(naive_activation<float>)->Name("GELU and slope/baseline std::erf and std::exp, float");
BENCHMARK(naive_activation<double>)->Name("GELU and slope/baseline std::erf and std::exp, double");
