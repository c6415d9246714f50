// SPDX-License-Identifier: MIT
// The same input one number at a time, in packs, on one and on two threads.
#include "target.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/packed.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/testing/random_states.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

namespace softtissue_fuzz {

using namespace softtissue;

namespace {

/// Numbers made of the bytes: mostly of size one, some that break formulas, some of any bits.
class Numbers {
public:
    explicit Numbers(Bytes bytes) : bytes_(bytes) {}

    int byte() { return place_ < bytes_.size() ? bytes_[place_++] : 37 * ++after_end_ % 160; }

    double next() {
        constexpr double least = std::numeric_limits<double>::denorm_min();
        constexpr std::array<double, 12> special{0.0,   -0.0,   1.0,   -1.0,  1e-300, least,
                                                 1e-20, -1e-30, 1e-10, 100.0, 1e6,    -1e10};
        const int kind = byte();
        if (kind < 200) {
            return (kind - 100) / 64.0;
        }
        if (kind < 212) {
            return special[size_t(kind - 200)];
        }
        std::uint64_t bits = 0;
        for (int k = 0; k < 8; ++k) {
            bits = bits << 8U | static_cast<std::uint64_t>(byte());
        }
        return std::bit_cast<double>(bits);
    }

    double finite(double largest) {
        const double x = next();
        return std::isfinite(x) ? std::clamp(x, -largest, largest) : 0.5;
    }

    template <class Matrix>
    Matrix matrix(double largest) {
        return Matrix::NullaryExpr([&] { return typename Matrix::Scalar(finite(largest)); });
    }

private:
    Bytes bytes_;
    size_t place_ = 0;
    int after_end_ = 0;
};

/// Which NaN comes out of several is the compiler's choice.
template <class A, class B, class Same>
bool are_same(const A& a, const B& b, const Same& same) {
    return std::equal(a.data(), a.data() + a.size(), b.data(), b.data() + b.size(),
                      [&](auto x, auto y) { return same(x, y) || (std::isnan(x) && std::isnan(y)); });
}

/// Rounding is bounded for states that are not too large and have one nearest rotation.
bool is_ordinary(const Matrix3<double>& F) {
    return F.allFinite() && F.cwiseAbs().maxCoeff() <= 20.0 && softtissue::detail::rotation_margin(F) >= 0.1;
}

template <class A, class B>
void expect_close(const A& packed, const B& plain, double scale, double tolerance, const char* what) {
    const double size = std::max(double(plain.cwiseAbs().maxCoeff()), scale);
    expect(double((packed - plain).cwiseAbs().maxCoeff()) <= tolerance * size, what);
}

/// Each lane as the plain law, within the tolerance of tests/unit/material/packed_test.cpp; its numbers whatever its neighbours.
template <class Material>
void packed_as_plain(const Material& material, const std::vector<Matrix3<double>>& states, double scale) {
    using S = typename Material::Scalar;
    constexpr int N = natural_lanes<S>;
    using Lanes = Pack<S, N>;
    using State = Matrix3<S>;
    const double tolerance = 3000 * double(std::numeric_limits<S>::epsilon());
    const auto law = packed_law<N>([&](int) -> const Material& { return material; });
    const auto state = [&](int i) -> State { return states[size_t(i)].template cast<S>(); };
    const auto together = [&](const auto& F) {
        Eigen::Matrix<Lanes, 9, 20> all;
        all.col(0).setConstant(law.energy_density(F));
        all.col(1) = Vector9<Lanes>(law.first_piola(F).reshaped());
        all.template middleCols<9>(2) = law.hessian(F);
        all.template rightCols<9>() = law.projected_hessian(F, PsdFilter::clamp);
        return all;
    };
    const auto packed = together(packed_matrix<N>(state));
    for (int i = 0; i < N; ++i) {
        const State F = state(i);
        const Eigen::Matrix<S, 9, 20> own = lane(packed, i);
        const auto alone = together(packed_matrix<N>([&](int) { return F; }));
        expect(are_same(Eigen::Matrix<S, 9, 20>(lane(alone, i)), own, std::equal_to<S>()),
               "a lane has the same numbers beside others");
        if (!is_ordinary(F.template cast<double>())) {
            continue;
        }
        const double psi = double(material.energy_density(F));
        expect(std::abs(double(own(0, 0)) - psi) <= tolerance * std::max(std::abs(psi), scale), "packed energy");
        expect_close(Vector9<S>(own.col(1)), Vector9<S>(material.first_piola(F).reshaped()), scale, tolerance,
                     "packed stress");
        const Matrix9<S> H = material.hessian(F);
        expect_close(Matrix9<S>(own.template middleCols<9>(2)), H, scale, tolerance, "packed Hessian");
        expect_close(Matrix9<S>(own.template rightCols<9>()), material.projected_hessian(F, PsdFilter::clamp),
                     std::max(double(H.cwiseAbs().maxCoeff()), scale), tolerance, "packed projected Hessian");
    }
}

void packed_materials(Numbers& numbers) {
    std::vector<Matrix3<double>> states;
    for (int i = 0; i < natural_lanes<float>; ++i) {
        states.push_back(Matrix3<double>::NullaryExpr([&] { return numbers.next(); }));
    }
    switch (numbers.byte() % 4) {
        case 0:
            return packed_as_plain(StableNeoHookean<double>({.mu = 4e3, .lambda = 2e4}), states, 1e4);
        case 1:
            return packed_as_plain(Arap<float>({.stiffness = 2.0F}), states, 1.0);
        case 2:
            return packed_as_plain(CorotatedLinearPolar<float>({.mu = 4e3F, .lambda = 2e4F}), states, 1e4);
        default:
            return packed_as_plain(FungOrthotropic<float>({.normal_modulus = 1e4F, .tangential_modulus = 3e4F},
                                                          Matrix3<float>::Identity()),
                                   states, 1e4);
    }
}

/// `compute(executor)` gives numbers whose bits must not depend on the executor; one thread is the plain loop.
template <class Compute>
void same_for_threads(const Compute& compute, const char* what) {
    static const ThreadExecutor one(1), two(2);
    const auto same_bits = [](auto x, auto y) { return std::memcmp(&x, &y, sizeof(x)) == 0; };
    expect(are_same(compute(one), compute(two), same_bits), what);
}

/// A column of prisms, each vertex shifted a little.
CellMesh<Prism6, double> prisms(Numbers& numbers) {
    constexpr Index levels = 5;
    CellMesh<Prism6, double> mesh{Matrix3X<double>(3, 4 * (levels + 1)), Connectivity<6>(6, 2 * levels)};
    for (Index v = 0; v < mesh.num_vertices(); ++v) {
        mesh.rest_positions.col(v) =
            Vector3<double>(double(v % 2), double(v / 2 % 2), double(v / 4)) + numbers.matrix<Vector3<double>>(0.1);
    }
    for (Index level = 0; level < levels; ++level) {
        const int a = int(4 * level);
        mesh.cells.col(2 * level) << a, a + 1, a + 2, a + 4, a + 5, a + 6;
        mesh.cells.col(2 * level + 1) << a + 1, a + 3, a + 2, a + 5, a + 7, a + 6;
    }
    return mesh;
}

void energy(Numbers& numbers) {
    using Material = StableNeoHookean<double>;
    const CellMesh<Prism6, double> mesh = prisms(numbers);
    ElasticEnergy<Prism6, UniformField<Material>> elastic(mesh, UniformField{Material({.mu = 1e4, .lambda = 1e5})});
    const Matrix3X<double> d = Matrix3X<double>::NullaryExpr(3, mesh.num_vertices(), [&] { return numbers.next(); });
    const std::vector<std::int32_t> held{0, 3};
    const PrescribedVertices prescribed(mesh.num_vertices(), held);
    std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
    elastic.add_neighbours(prescribed, neighbours);
    BlockMatrix<double> hessian{BlockPattern(std::move(neighbours))};
    elastic.bind(prescribed, hessian.pattern());
    same_for_threads(
        [&](const ThreadExecutor& executor) {
            Matrix3X<double> gradient = Matrix3X<double>::Zero(3, d.cols());
            hessian.set_zero();
            const double together = elastic.add_energy_and_gradient(d, gradient, executor);
            elastic.add_hessian(d, PsdFilter::clamp, hessian, executor);
            std::vector<double> all{elastic.energy(d, executor), together};
            all.insert(all.end(), gradient.data(), gradient.data() + gradient.size());
            const auto& matrix = hessian.matrix();
            all.insert(all.end(), matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros());
            return all;
        },
        "an energy has the same bits on two threads");
}

template <class Policy>
void skinning(const Policy& policy, Numbers& numbers) {
    using S = typename Policy::Scalar;
    constexpr Index points = 11;
    std::vector<AffineTransform<S>> joints(3);
    for (AffineTransform<S>& joint : joints) {
        const Vector3<S> turn = numbers.matrix<Vector3<S>>(4.0);
        joint.linear = rotation_matrix_from_rotation_vector(turn);
        joint.translation = numbers.matrix<Vector3<S>>(1e6);
    }
    MatrixX<S> dense(points, 3);
    for (Index v = 0; v < points; ++v) {
        const S first = S(numbers.byte()) / S(255), second = (S(1) - first) * S(numbers.byte()) / S(255);
        dense.row(v) << first, second, S(1) - first - second;
    }
    const SkinningWeights<S> weights(dense.cwiseMax(S(0)));
    const Matrix3X<S> rest = Matrix3X<S>::NullaryExpr(3, points, [&] { return S(numbers.finite(1e6)); });
    same_for_threads(
        [&](const ThreadExecutor& executor) {
            MatrixX<S> prepared;
            Matrix3X<S> x;
            skin_points_into(policy, joints, weights, rest, prepared, x, executor);
            return x;
        },
        "skinning has the same bits on two threads");
}

void embedding(Numbers& numbers) {
    const CellMesh<Prism6, double> mesh = prisms(numbers);
    const Matrix3X<double> points = Matrix3X<double>::NullaryExpr(3, 13, [&] { return numbers.finite(1e3); });
    const Matrix3X<double> x =
        mesh.rest_positions + Matrix3X<double>::NullaryExpr(3, mesh.num_vertices(), [&] { return numbers.next(); });
    same_for_threads(
        [&](const ThreadExecutor& executor) {
            const Embedding<double> embedded(points, mesh, executor);
            expect(embedded.weights().allFinite(), "weights of an embedding are finite");
            Matrix3X<double> out(3, points.cols());
            embedded.apply_into(x, out, executor);
            return out;
        },
        "an embedding has the same bits on two threads");
}

void perceptron(Numbers& numbers) {
    const Index batch = 1 + numbers.byte() % 9;
    Mlp<float> mlp({.inputs = 1 + numbers.byte() % 20, .hidden = {1 + numbers.byte() % 40, 9}, .outputs = 7});
    mlp.initialize(std::uint64_t(numbers.byte()));
    for (int k = 0; k < 8; ++k) {
        mlp.parameters()(numbers.byte() % mlp.parameters().size()) = float(numbers.finite(1e30));
    }
    const MatrixX<float> inputs =
        MatrixX<float>::NullaryExpr(mlp.sizes().inputs, batch, [&] { return float(numbers.next()); });
    same_for_threads(
        [&](const ThreadExecutor& executor) {
            auto scratch = mlp.make_scratch(batch);
            auto tape = mlp.make_tape(batch);
            MatrixX<float> outputs(7, batch), again(7, batch);
            VectorX<float> gradient;
            mlp.infer_into(inputs, scratch, outputs, executor);
            mlp.forward_into(inputs, tape, again, executor);
            mlp.backward_into(inputs, tape, again, gradient, executor);
            std::vector<float> all(outputs.data(), outputs.data() + outputs.size());
            all.insert(all.end(), again.data(), again.data() + again.size());
            all.insert(all.end(), gradient.data(), gradient.data() + gradient.size());
            return all;
        },
        "a network has the same bits on two threads");
}

void agreement(Bytes bytes) {
    Numbers numbers(bytes);
    switch (numbers.byte() % 6) {
        case 0:
            return packed_materials(numbers);
        case 1:
            return energy(numbers);
        case 2:
            return skinning(LinearBlend<float>(), numbers);
        case 3:
            return skinning(DualQuaternion<double>(), numbers);
        case 4:
            return embedding(numbers);
        default:
            return perceptron(numbers);
    }
}

}  // namespace

std::span<const Target> agreement_targets() {
    static constexpr std::array<Target, 1> targets{{{"agreement", Container::none, agreement}}};
    return targets;
}

}  // namespace softtissue_fuzz
