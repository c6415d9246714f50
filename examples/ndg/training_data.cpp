// SPDX-License-Identifier: MIT
#include "training_data.hpp"

#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/ndg/pose_features.hpp>
#include <softtissue/ndg/residual_gradients.hpp>
#include <softtissue/ndg/rest_offsets.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/cell_weights.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace examples {

namespace {

/// Turns samples into columns. Weights, cells and prescribed vertices are the same for all bodies of a data set.
class SampleColumns {
public:
    SampleColumns(const DatasetFolder& data, const NetworkOptions& options)
        : data_(data),
          options_(options),
          blended_(cell_weights(data.mean_body().weights, data.mean_body().mesh.cells)),
          prescribed_(data.mean_body().mesh.num_vertices(), data.mean_body().prescribed) {}

    Index num_outputs() const {
        return options_.kind == NetworkKind::gradient ? 9 * data_.mean_body().mesh.num_cells()
                                                      : 3 * prescribed_.num_free();
    }

    struct Counts {
        Index inverted_cells = 0, skipped_vertices = 0;
    };

    Counts write(Index sample_index, const ShapeSpace<double>& shapes, Eigen::Ref<VectorX<float>> input,
                 Eigen::Ref<VectorX<float>> target) const {
        const DatasetSample sample = data_.sample(sample_index);
        const ShapedBody<double> body = data_.body(sample.body);
        const CellMesh<Prism6, double>& mesh = body.layered.mesh;
        const Index num_features = num_pose_features(data_.tree());
        pose_features_into<float>(data_.tree(), sample.pose, input.head(num_features));
        if (options_.shape_input) {
            input.tail(input.size() - num_features) = shapes.encode(mesh.rest_positions).cast<float>();
        }
        const std::vector<AffineTransform<double>> transforms =
            joint_transforms<double>(data_.tree(), body.joints, sample.pose);
        Counts counts;
        if (options_.kind == NetworkKind::vertex) {
            counts.skipped_vertices =
                rest_offsets_into<float, double>(body.layered, prescribed_, transforms, sample.positions, target);
            return counts;
        }
        const auto rest = RestOperators<Prism6, double>::at(mesh, mesh.rest_positions);
        const std::vector<Matrix3<double>> rotations =
            options_.rotation ? blended_.rotations(transforms)
                              : std::vector<Matrix3<double>>(size_t(mesh.num_cells()),
                                                             transforms[size_t(data_.tree().root())].linear);
        Eigen::Map<MatrixX<float>> residuals(target.data(), 9, mesh.num_cells());
        residual_gradients_into<float, Prism6, double>(mesh, rest, rotations, sample.positions, residuals);
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            counts.inverted_cells += determinant<float>(residuals.col(c).reshaped(3, 3)) > 0.0F ? 0 : 1;
        }
        return counts;
    }

private:
    const DatasetFolder& data_;
    NetworkOptions options_;
    BlendedRotations<double> blended_;
    PrescribedVertices prescribed_;
};

/// Of the bodies of the training samples alone.
ShapeSpace<double> learn_shapes(const DatasetFolder& data, const std::vector<Index>& samples,
                                const TrainingDataOptions& options, Index& num_bodies, const ThreadExecutor& executor) {
    std::vector<Matrix3X<double>> bodies;
    std::int32_t last = -1;
    for (const Index sample : samples) {  // ascending in body
        const std::int32_t body = data.plan().samples[size_t(sample)].body;
        if (body != last) {
            bodies.push_back(data.body(body).layered.mesh.rest_positions);
            last = body;
        }
    }
    num_bodies = Index(bodies.size());
    if (!options.network.shape_input) {
        return {};
    }
    return ShapeSpace<double>::from_bodies(
        bodies, {.variance = options.shape_variance, .max_components = options.max_shape_coefficients}, executor);
}

}  // namespace

TrainingSplit training_split(const DatasetFolder& data, Index max_samples) {
    TrainingSplit split{data.finished(DatasetSplit::train), data.finished(DatasetSplit::validation)};
    if (max_samples > 0 && Index(split.training.size()) > max_samples) {
        split.training.resize(size_t(max_samples));
    }
    require(!split.training.empty() && !split.validation.empty(), data.path().string(), ": ", split.training.size(),
            " training and ", split.validation.size(), " validation samples are finished, expected some of both");
    return split;
}

TrainingData load_training_data(const DatasetFolder& data, const TrainingSplit& split,
                                const TrainingDataOptions& options, const ThreadExecutor& executor,
                                const std::function<void(int, int)>& progress) {
    TrainingData result;
    result.shape_space = learn_shapes(data, split.training, options, result.num_bodies, executor);
    const SampleColumns columns(data, options.network);
    const Index num_inputs = num_pose_features(data.tree()) + result.shape_space.num_coefficients();
    std::mutex mutex;
    int done = 0;
    const int total = int(split.training.size() + split.validation.size());
    for (const bool is_training : {true, false}) {
        const std::vector<Index>& indices = is_training ? split.training : split.validation;
        NetworkSamples<float>& samples = is_training ? result.training : result.validation;
        samples.inputs.resize(num_inputs, Index(indices.size()));
        samples.targets.resize(columns.num_outputs(), Index(indices.size()));
        executor.for_each_range(Index(indices.size()), [&](Index begin, Index end) {
            for (Index k = begin; k < end; ++k) {
                const SampleColumns::Counts counts = columns.write(indices[size_t(k)], result.shape_space,
                                                                   samples.inputs.col(k), samples.targets.col(k));
                const std::lock_guard<std::mutex> lock(mutex);
                if (is_training) {
                    result.inverted_cells += counts.inverted_cells;
                    result.skipped_vertices += counts.skipped_vertices;
                }
                progress(++done, total);
            }
        });
    }
    return result;
}

CompressedTargets compress_targets(TrainingData& data, double variance, const ThreadExecutor& executor) {
    CompressedTargets result;
    const PrincipalComponents<float> components =
        principal_components<float>(data.training.targets, {.variance = variance}, executor);
    result.explained = components.explained;
    result.training = {data.training.inputs, components.encode_columns(data.training.targets, executor)};
    data.training.targets.resize(0, 0);
    result.validation = {data.validation.inputs, components.encode_columns(data.validation.targets, executor)};
    data.validation.targets.resize(0, 0);
    result.decoder = {components.components * components.standard_deviations.asDiagonal(), components.mean};
    result.loss.weights = components.standard_deviations.cwiseAbs2() / float(components.mean.size());
    return result;
}

}  // namespace examples
