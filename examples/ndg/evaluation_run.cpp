// SPDX-License-Identifier: MIT
#include "evaluation_run.hpp"

#include "../support/column_errors.hpp"
#include "../support/posing_methods.hpp"
#include "../support/progress.hpp"

#include <softtissue/ndg/network_input.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace examples {

namespace {

/// One method on one sample.
struct MeasuredPose {
    PoseFigures<double> figures;
    VectorX<double> column_errors;
    bool has_converged = true;
    std::optional<double> smallest_determinant = {};
};

/// The flesh that the data set was made with.
FleshParameters<double> flesh_of(const DatasetFolder& data) {
    const nlohmann::ordered_json& flesh = data.definition().at("flesh");
    const auto constants = [&](const char* layer) {
        return YoungPoisson<double>{flesh.at(layer).at(0).get<double>(), flesh.at(layer).at(1).get<double>()};
    };
    return {.muscle = constants("muscle"),
            .fat = constants("fat"),
            .stretch = flesh.at("stretch").get<double>(),
            .bending = flesh.at("bending").get<double>()};
}

/// All methods on one body.
class BodyEvaluation {
public:
    BodyEvaluation(const DatasetFolder& data, Index body, const EvaluationSetup& setup)
        : data_(data), setup_(setup), body_(data.body(body)), methods_(body_.layered, flesh_of(data), 1) {
        for (const EvaluatedModel& model : setup.models) {
            networks_.push_back(std::make_unique<PosingNetwork>(
                model.model, body_.layered, data.tree(), data.joint_names(), methods_.poisson(), 1, model.small.get()));
        }
    }

    /// In the order of SplitResult::methods.
    std::vector<MeasuredPose> measure(Index index) {
        const DatasetSample sample = data_.sample(index);
        const auto transforms = joint_transforms<double>(data_.tree(), body_.joints, sample.pose);
        std::vector<MeasuredPose> result;
        result.push_back(measured(sample.positions, sample.positions, std::numeric_limits<double>::quiet_NaN()));
        Matrix3X<double> x;
        for (size_t k = 0; k < networks_.size(); ++k) {
            const double begin = seconds();
            networks_[k]->pose_into(sample.pose, transforms, x);
            const double time = 1e3 * (seconds() - begin);
            result.push_back(measured(x, sample.positions, time));
            if (setup_.models[k].model.options.kind == NetworkKind::gradient) {
                result.back().smallest_determinant = double(networks_[k]->smallest_determinant());
            }
        }
        for (const std::string& name : setup_.methods) {
            const double begin = seconds();
            const SolveReport<double> report = methods_.pose_into(method_of(name), transforms, x);
            const double time = 1e3 * (seconds() - begin);
            result.push_back(measured(x, sample.positions, time));
            result.back().has_converged = report.succeeded();
        }
        return result;
    }

private:
    MeasuredPose measured(const Matrix3X<double>& x, const Matrix3X<double>& reference, double milliseconds) {
        const Poisson& poisson = methods_.poisson();
        MeasuredPose result;
        result.figures = measure_pose(body_.layered.mesh, poisson.rest(), poisson.prescribed(), x, reference);
        result.figures.milliseconds = milliseconds;
        result.column_errors = column_errors(body_.layered, x, reference);
        return result;
    }

    const DatasetFolder& data_;
    const EvaluationSetup& setup_;
    ShapedBody<double> body_;
    PosingMethods methods_;
    std::vector<std::unique_ptr<PosingNetwork>> networks_;
};

/// Samples of one body, which one worker takes together.
using SampleRange = std::pair<size_t, size_t>;

std::vector<SampleRange> ranges_by_body(const DatasetFolder& data, const std::vector<Index>& samples) {
    std::vector<SampleRange> ranges;
    for (size_t k = 0; k < samples.size(); ++k) {
        const auto body = [&](size_t i) { return data.plan().samples[size_t(samples[i])].body; };
        if (k == 0 || body(k) != body(k - 1)) {
            ranges.emplace_back(k, k);
        }
        ranges.back().second = k + 1;
    }
    return ranges;
}

/// Takes results in any order and adds them in that of the samples.
class OrderedResults {
public:
    OrderedResults(SplitResult& result, std::vector<Index> samples, Progress& progress)
        : result_(result), samples_(std::move(samples)), progress_(progress) {}

    void take(size_t number, std::vector<MeasuredPose> poses) {
        const std::lock_guard<std::mutex> lock(mutex_);
        waiting_.emplace(number, std::move(poses));
        while (!waiting_.empty() && waiting_.begin()->first == next_) {
            add_first();
            ++next_;
        }
        progress_.update(++num_taken_);
    }

    /// After an interruption: what has a gap before it.
    void take_rest() {
        while (!waiting_.empty()) {
            add_first();
        }
    }

private:
    void add_first() {
        const auto first = waiting_.begin();
        result_.samples.push_back(samples_[first->first]);
        for (size_t k = 0; k < result_.methods.size(); ++k) {
            MethodResult& method = result_.methods[k];
            const MeasuredPose& pose = first->second[k];
            method.evaluation.add(pose.figures, pose.column_errors);
            method.not_converged += pose.has_converged ? 0 : 1;
            if (!method.smallest_determinant || pose.smallest_determinant < method.smallest_determinant) {
                method.smallest_determinant = pose.smallest_determinant;
            }
        }
        waiting_.erase(first);
    }

    SplitResult& result_;
    std::vector<Index> samples_;
    Progress& progress_;
    std::mutex mutex_;
    std::map<size_t, std::vector<MeasuredPose>> waiting_;
    size_t next_ = 0;
    int num_taken_ = 0;
};

}  // namespace

MatrixX<float> typical_inputs(const DatasetFolder& data, const NeuralModel<float>& model) {
    const std::vector<Index> training = data.finished(DatasetSplit::train);
    const size_t step = (training.size() + 199) / 200;
    MatrixX<float> inputs(model.mlp.sizes().inputs, 0);
    for (size_t k = 0; k < training.size(); k += step) {
        const DatasetSample sample = data.sample(training[k]);
        const ShapedBody<double> body = data.body(data.plan().samples[size_t(training[k])].body);
        inputs.conservativeResize(Eigen::NoChange, inputs.cols() + 1);
        network_input_into<float, double>(model, data.tree(), sample.pose,
                                          shape_input(model, body.layered.mesh.rest_positions),
                                          inputs.col(inputs.cols() - 1));
    }
    return inputs;
}

SplitResult evaluate_split(const DatasetFolder& data, DatasetSplit split, const EvaluationSetup& setup) {
    SplitResult result;
    result.split = split;
    result.methods.push_back({.name = "fem"});
    for (const EvaluatedModel& model : setup.models) {
        result.methods.push_back({.name = model.name});
    }
    for (const std::string& name : setup.methods) {
        result.methods.push_back({.name = name});
    }
    std::vector<Index> samples = data.finished(split);
    if (setup.max_samples > 0 && Index(samples.size()) > setup.max_samples) {
        for (Index k = 0; k < setup.max_samples; ++k) {  // evenly spread
            samples[size_t(k)] = samples[size_t(k) * samples.size() / size_t(setup.max_samples)];
        }
        samples.resize(size_t(setup.max_samples));
    }
    const std::vector<SampleRange> ranges = ranges_by_body(data, samples);
    Progress progress(std::string("evaluating ") + to_string(split), std::max(1, int(samples.size())));
    OrderedResults ordered(result, samples, progress);
    std::atomic<size_t> next_range{0};
    std::atomic<bool> has_failed{false};
    std::vector<std::exception_ptr> errors(size_t(setup.threads));
    const auto work = [&](std::exception_ptr& error) {
        try {
            for (size_t r = next_range++; r < ranges.size() && !is_interrupted() && !has_failed; r = next_range++) {
                BodyEvaluation body(data, data.plan().samples[size_t(samples[ranges[r].first])].body, setup);
                for (size_t k = ranges[r].first; k < ranges[r].second && !is_interrupted(); ++k) {
                    ordered.take(k, body.measure(samples[k]));
                }
            }
        } catch (...) {
            error = std::current_exception();
            has_failed = true;
        }
    };
    std::vector<std::thread> workers;
    for (int t = 1; t < setup.threads; ++t) {
        workers.emplace_back([&, t] { work(errors[size_t(t)]); });
    }
    work(errors[0]);
    for (std::thread& worker : workers) {
        worker.join();
    }
    for (const std::exception_ptr& error : errors) {
        if (error) {
            std::rethrow_exception(error);
        }
    }
    ordered.take_rest();
    result.num_bodies = Index(ranges_by_body(data, result.samples).size());
    result.is_interrupted = is_interrupted();
    return result;
}

}  // namespace examples
