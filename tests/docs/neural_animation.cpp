// The fragments of docs/neural_deformation_gradients.md, compiled.
#include <softtissue/anatomy/make_layered_body.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/io/neural_model_file.hpp>
#include <softtissue/ndg/network_input.hpp>
#include <softtissue/ndg/neural_animation.hpp>
#include <softtissue/nn/quantized_mlp.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <vector>

using namespace softtissue;

template <class>
void animate(const SmplBody<double>& body, const Matrix3X<double>& joints, const Pose<double>& pose,
             Matrix3X<double>& x) {
    const SequentialExecutor executor;
    const NeuralModel<float> model = read_neural_model<float>("ndg.safetensors");
    const LayeredBody<double> layered = make_layered_body(body);
    PoissonReconstruction<Prism6, double> poisson(layered.mesh,
                                                  PrescribedVertices(layered.mesh.num_vertices(), layered.prescribed));
    NeuralAnimation<double, SequentialExecutor> animation(model, layered, body.tree, body.joint_names, poisson,
                                                          executor);

    // per frame; x: 3 x vertices of all layers
    animation.pose_into(pose, joint_transforms(body.tree, joints, pose), x);
}

template <class>
void animate_small(const NeuralModel<float>& model, const LayeredBody<double>& layered, const SmplBody<double>& body,
                   const std::vector<Pose<double>>& poses, PoissonReconstruction<Prism6, double>& poisson) {
    const SequentialExecutor executor;
    const MatrixX<float> inputs =
        network_inputs<float, double>(model, body.tree, poses, shape_input(model, layered.mesh.rest_positions));
    const QuantizedMlp<float> small(model.mlp, WeightFormat::int4, inputs);
    NeuralAnimation<double, SequentialExecutor> animation(model, layered, body.tree, body.joint_names, poisson,
                                                          executor, &small);
}
