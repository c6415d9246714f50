// SPDX-License-Identifier: MIT
// Networks that predict deformation gradients: a training step beside its matrix products alone, inference at the paper's
// size beside one reading of the weights, activations beside those by std::erf.

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/nn/adamw.hpp>
#include <softtissue/nn/gelu.hpp>
#include <softtissue/nn/mlp.hpp>

#include <benchmark/benchmark.h>

#include <cmath>

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
    state.SetItemsProcessed(state.iterations() * batch);
    state.counters["flop/s"] =
        benchmark::Counter(6 * num_weights(small_body) * double(batch), benchmark::Counter::kIsIterationInvariantRate);
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
    state.SetItemsProcessed(state.iterations() * batch);
    state.counters["flop/s"] =
        benchmark::Counter(6 * num_weights(small_body) * double(batch), benchmark::Counter::kIsIterationInvariantRate);
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
    state.SetBytesProcessed(state.iterations() * size * 28);
}

Mlp<float>& paper_network() {
    static Mlp<float> network = [] {
        Mlp<float> result(paper_body);
        result.parameters().setConstant(1e-3F);
        return result;
    }();
    return network;
}

/// One sample; bytes are those of the weights. Argument: threads.
void inference_at_paper_size(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const Mlp<float>& network = paper_network();
    auto scratch = network.make_scratch(1);
    const MatrixX<float> x = random_columns(paper_body.inputs, 1);
    MatrixX<float> y(paper_body.outputs, 1);
    for (auto _ : state) {
        network.infer_into(x, scratch, y, executor);
        benchmark::DoNotOptimize(y.data());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * network.parameters().size() * Index(sizeof(float)));
}

/// The same bytes, added up.
void reading_the_weights(benchmark::State& state) {
    const ThreadExecutor executor(int(state.range(0)));
    const VectorX<float>& weights = paper_network().parameters();
    for (auto _ : state) {
        executor.for_each_range(weights.size(), [&](Index begin, Index end) {
            const float* const from = weights.data() + begin;
            benchmark::DoNotOptimize(detail::lane_sum<float>(end - begin, [from](Index i) { return from[i]; }));
        });
    }
    state.SetBytesProcessed(state.iterations() * weights.size() * Index(sizeof(float)));
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
    state.SetItemsProcessed(state.iterations() * 4096);
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
    state.SetItemsProcessed(state.iterations() * 4096);
}

}  // namespace

BENCHMARK(training_step)->Args({16, 1})->Args({32, 1})->Args({16, 2})->Args({32, 2})->Unit(benchmark::kMillisecond);
BENCHMARK(products_of_a_training_step)->Arg(16)->Arg(32)->Unit(benchmark::kMillisecond);
BENCHMARK(adamw_step)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(inference_at_paper_size)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(reading_the_weights)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(activation<float, Gelu>);
BENCHMARK(activation<double, Gelu>);
BENCHMARK(activation<float, TanhGelu>);
BENCHMARK(naive_activation<float>);
BENCHMARK(naive_activation<double>);
