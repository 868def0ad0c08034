#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "export/cache_layout.h"
#include "export/usd/usd_mesh.h"

namespace toile::exports {

/// Text of a USD stage of moving meshes, and their latest samples. Each mesh NAMEShape lies in a transform
/// NAME, for programs that show no mesh without one, and that in its group. A transform at the top holds
/// all, so that a reference to the file brings everything.
class UsdStage {
public:
    /// @param name    of the transform at the top
    /// @param layout  with names: with_names()
    UsdStage(const std::string& name, const CacheLayout& layout);

    /// Appends a sample of all meshes.
    void add_sample(const MovingSample& sample);
    int sample_count() const { return int(times_.size()); } ///< that are kept
    void drop_all_but_last();

    void write_whole(const std::filesystem::path& file) const;
    void write_clip(const std::filesystem::path& file) const;
    void write_manifest(const std::filesystem::path& file) const;

    /// A clip and the first sample that it shows.
    struct Clip {
        std::string asset; ///< path from the stage's file
        int first_sample;
    };
    /// @param sample_count  of all clips
    void write_root(const std::filesystem::path& file, const std::vector<Clip>& clips,
                    const std::string& manifest, int sample_count) const;

private:
    /// A transform.
    struct Group {
        std::string name; ///< as given
        std::vector<Group> groups;
        int mesh = -1; ///< in meshes_; -1: none
    };

    static Group tree_of(const std::string& name, const CacheLayout& layout);
    void write_header(UsdFile& file, double first_time, double last_time) const;
    /// @param parent    path of the prim that it lies in; empty for the top
    /// @param metadata  of the group
    void write_group(UsdFile& file, UsdLayer layer, const Group& group, const std::string& parent,
                     const std::string& metadata) const;

    CacheLayout layout_; ///< without faces
    Group top_;
    std::vector<UsdMesh> meshes_;
    int next_sample_ = 0;
    std::vector<double> times_; ///< [frames] of the samples that are kept
};

} // namespace toile::exports
