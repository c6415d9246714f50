// SPDX-License-Identifier: MIT
/// @file
/// A data set of posed layered bodies on disk.
///
/// What        plan.json            what defines the data set; written last, so that a folder that has it is complete as a plan
///             plan.npz             body_split (B), body_betas (B, k); pose_split (P), poses (P, J, 3) [rad], pose_source (P, 4):
///                                  clip, frame, those of the legs, pose_noise (P); clips; sample_split, sample_body, sample_pose (N)
///             body.npz             the mean shape, see io/layered_body_file.hpp
///             bodies/000007.npz    the shape of a body, written before its first sample
///             samples/000123.npz   see io/sample_file.hpp
///             failed/000123.json   a sample that failed: "reason", and what it was
///             Files appear whole or not at all, under names that depend on their content alone.
/// Refuses     a folder without plan, of another format, or that belongs to another plan; a sample or body that is not there,
///             or not of this plan (InvalidInput names the file).
/// Example     const DatasetFolder data("ndg_data");
///             for (const Index i : data.finished(DatasetSplit::train)) {
///                 const DatasetSample sample = data.sample(i);
///                 const ShapedBody<double> body = data.body(sample.body);
/// Tests       tests/unit/io/dataset_folder_test.cpp
#pragma once

#if !__has_include(<nlohmann/json.hpp>)
#error "softtissue: io/dataset_folder.hpp needs nlohmann-json (Debian: nlohmann-json3-dev)"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/dataset_plan_file.hpp>
#include <softtissue/io/folder_lock.hpp>
#include <softtissue/io/layered_body_file.hpp>
#include <softtissue/io/output_folder.hpp>
#include <softtissue/io/sample_file.hpp>
#include <softtissue/ndg/dataset_plan.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

class DatasetFolder {
public:
    static constexpr int format = 1;

    /// Opens a data set.
    explicit DatasetFolder(std::filesystem::path path) : path_(std::move(path)) {
        require(has_plan(path_), path_.string(), ": no data set, expected a folder with a plan.json");
        definition_ = read_json(path_ / "plan.json");
        require(definition_.value("format", nlohmann::ordered_json()) == format, (path_ / "plan.json").string(),
                ": format is ", definition_.value("format", nlohmann::ordered_json()).dump(), ", expected ", format);
        plan_ = read_dataset_plan(path_ / "plan.npz");
        mean_ = read_layered_body<double>(path_ / "body.npz");
    }

    static bool has_plan(const std::filesystem::path& path) { return std::filesystem::exists(path / "plan.json"); }

    /// Makes the folder of a new data set; `definition` is all that its files depend on. Of several processes that do so at
    /// once one makes it; the others, and whoever comes later, throw unless theirs is the same.
    static void create(const std::filesystem::path& path, nlohmann::ordered_json definition, const DatasetPlan& plan,
                       const SkeletalLayers<double>& mean) {
        for (const char* name : {"bodies", "samples", "failed"}) {
            make_output_folder(path / name);
        }
        const FolderLock one_at_a_time(path);
        if (has_plan(path)) {
            DatasetFolder(path).require_definition(std::move(definition));
            return;
        }
        write_dataset_plan(path / "plan.npz", plan);
        write_layered_body(path / "body.npz", mean);
        definition["format"] = format;
        write_text(path / "plan.json", definition.dump(2) + "\n");
    }

    /// Throws unless this data set was made from `definition`.
    void require_definition(nlohmann::ordered_json definition) const {
        definition["format"] = format;
        for (const auto& [key, value] : definition.items()) {
            require(definition_.contains(key) && definition_[key] == value, path_.string(),
                    ": belongs to another data set: ", key, " is ",
                    definition_.value(key, nlohmann::ordered_json()).dump(), ", expected ", value.dump(),
                    "; choose another folder");
        }
        require(definition_ == definition, path_.string(), ": belongs to another data set; choose another folder");
    }

    const std::filesystem::path& path() const { return path_; }
    const nlohmann::ordered_json& definition() const { return definition_; }
    const DatasetPlan& plan() const { return plan_; }
    const KinematicTree& tree() const { return mean_.tree; }
    const std::vector<std::string>& joint_names() const { return mean_.joint_names; }
    const LayeredBody<double>& mean_body() const { return mean_.body.layered; }

    std::filesystem::path body_path(Index body) const { return numbered("bodies", body, ".npz"); }
    std::filesystem::path sample_path(Index sample) const { return numbered("samples", sample, ".npz"); }
    std::filesystem::path failure_path(Index sample) const { return numbered("failed", sample, ".json"); }

    bool is_finished(Index sample) const { return std::filesystem::exists(sample_path(sample)); }
    bool is_failed(Index sample) const { return std::filesystem::exists(failure_path(sample)); }

    /// The samples of a split that are there, ascending.
    std::vector<Index> finished(DatasetSplit split) const {
        return samples_where([&](Index i) { return plan_.samples[size_t(i)].split == split && is_finished(i); });
    }

    /// The samples that failed, ascending.
    std::vector<Index> failed() const {
        return samples_where([&](Index i) { return is_failed(i); });
    }

    DatasetSample sample(Index index) const {
        require(index >= 0 && index < plan_.num_samples(), path_.string(), ": sample ", index, ", expected 0 to ",
                plan_.num_samples() - 1);
        DatasetSample result = read_sample(sample_path(index));
        const PlannedSample& planned = plan_.samples[size_t(index)];
        require(result.sample == index && result.body == planned.body && result.pose_index == planned.pose,
                sample_path(index).string(), ": is sample ", result.sample, " of body ", result.body,
                ", expected sample ", index, " of body ", planned.body);
        require(result.positions.cols() == mean_body().mesh.num_vertices(), sample_path(index).string(), ": ",
                result.positions.cols(), " positions, expected ", mean_body().mesh.num_vertices());
        return result;
    }

    /// The layered body and the rest joints of a body.
    ShapedBody<double> body(Index index) const { return read_body_shape(body_path(index), mean_.body); }

    void write(const DatasetSample& sample) const { write_sample(sample_path(sample.sample), sample); }

    void write_body(Index index, const ShapedBody<double>& body) const {
        write_body_shape(body_path(index), body, plan_.bodies[size_t(index)].betas);
    }

    void write_failure(Index sample, nlohmann::ordered_json failure) const {
        const PlannedSample& planned = plan_.samples[size_t(sample)];
        failure["sample"] = sample;
        failure["split"] = to_string(planned.split);
        failure["body"] = planned.body;
        failure["pose"] = planned.pose;
        write_text(failure_path(sample), failure.dump(2) + "\n");
    }

    /// Why a sample failed.
    std::string failure(Index sample) const {
        const nlohmann::ordered_json file = read_json(failure_path(sample));
        return file.value("reason", std::string("unknown"));
    }

private:
    static nlohmann::ordered_json read_json(const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
        const nlohmann::ordered_json::parser_callback_t refuse_depth = [&](int depth, auto, const auto&) {
            constexpr int deepest = 100;  // copies and texts of it are made by recursion
            require(depth < deepest, path.string(), ": is nested too deeply");
            return true;
        };
        nlohmann::ordered_json json = nlohmann::ordered_json::parse(text, refuse_depth, false);
        require(json.is_object(), path.string(), ": is damaged, expected a JSON object");
        return json;
    }

    static void write_text(const std::filesystem::path& path, const std::string& text) {
        AtomicFile file(path);
        file.write(text);
        file.commit();
    }

    std::filesystem::path numbered(const char* folder, Index number, const char* extension) const {
        std::string digits = std::to_string(number);
        digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
        return path_ / folder / (digits + extension);
    }

    template <class Condition>
    std::vector<Index> samples_where(const Condition& condition) const {
        std::vector<Index> result;
        for (Index i = 0; i < plan_.num_samples(); ++i) {
            if (condition(i)) {
                result.push_back(i);
            }
        }
        return result;
    }

    std::filesystem::path path_;
    nlohmann::ordered_json definition_;
    DatasetPlan plan_;
    SkeletalLayers<double> mean_;
};

}  // namespace softtissue
