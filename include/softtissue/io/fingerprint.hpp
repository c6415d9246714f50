// SPDX-License-Identifier: MIT
/// @file
/// A short number that tells contents apart: to recognise bodies and motions, not to protect against malice.
///
/// What        FNV-1a, 64 bit, over bytes: of numbers in this machine's order, of texts, of sparse and dense arrays with sizes.
/// Source      Fowler, Noll, Vo 1991
/// Tests       tests/unit/io/fingerprint_test.cpp
#pragma once

#include <softtissue/core/byte_hash.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softtissue {

class Fingerprint {
public:
    Fingerprint& add_bytes(const void* data, std::size_t size) {
        hash_.add(data, size);
        return *this;
    }

    Fingerprint& add(std::string_view text) {
        add_number(std::int64_t(text.size()));
        return add_bytes(text.data(), text.size());
    }

    /// Size and values in storage order.
    template <class Derived>
    Fingerprint& add(const Eigen::PlainObjectBase<Derived>& array) {
        add_number(std::int64_t(array.rows()));
        return add_bytes(array.data(), std::size_t(array.size()) * sizeof(typename Derived::Scalar));
    }

    template <RealScalar S>
    Fingerprint& add(const Motion<S>& motion) {
        add_number(motion.frame_rate);
        for (const Pose<S>& pose : motion.poses) {
            add(pose.rotation_vectors).add(pose.translation);
        }
        return *this;
    }

    /// What decides about layers and skinning: not the pose blend shapes, not the names.
    template <RealScalar S>
    Fingerprint& add(const SmplBody<S>& body) {
        add(body.template_vertices).add(body.faces).add(body.shape_directions);
        for (const std::int32_t parent : body.tree.parents()) {
            add_number(parent);
        }
        for (Index v = 0; v < body.weights.num_vertices(); ++v) {
            for (const auto& [joint, weight] : body.weights.row(v)) {
                add_number(joint).add_number(weight);
            }
        }
        for (Index j = 0; j < body.joint_regressor.rows(); ++j) {
            for (typename SmplBody<S>::SparseMatrix::InnerIterator entry(body.joint_regressor, j); entry; ++entry) {
                add_number(std::int64_t(entry.col())).add_number(entry.value());
            }
        }
        return *this;
    }

    template <class Number>
    Fingerprint& add_number(Number number) {
        return add_bytes(&number, sizeof number);
    }

    /// Sixteen hexadecimal digits.
    std::string text() const {
        std::string digits;
        for (int shift = 60; shift >= 0; shift -= 4) {
            digits += "0123456789abcdef"[(hash_.value() >> shift) & 0xfU];
        }
        return digits;
    }

private:
    ByteHash hash_;
};

}  // namespace softtissue
