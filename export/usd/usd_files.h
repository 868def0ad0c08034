#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace toile::exports {

/// Samples of a .usda file. A longer cache has a root file and value clips of so many samples.
constexpr int kUsdSamplesPerFile = 50;

/// Value clips of a .usda cache of so many samples; none for a short one.
int usd_clip_count(int sample_count);

/// Files of a .usda cache with value clips: skirt.usda, and in the folder skirt_clips beside it
/// skirt.0000.usda, skirt.0001.usda, ... and skirt.manifest.usda.
class UsdFiles {
public:
    explicit UsdFiles(std::filesystem::path root) : root_(std::move(root)) {}

    const std::filesystem::path& root() const { return root_; }
    std::filesystem::path clip_folder() const;
    std::filesystem::path clip(int number) const;
    std::filesystem::path manifest() const;
    /// Path of one of them from the root's folder, as the root names it.
    std::string asset(const std::filesystem::path& file) const;

    /// Clips and manifests that exist in the folder, those of a killed writer too.
    std::vector<std::filesystem::path> existing() const;
    /// Removes them, and the folder if nothing else is in it.
    void remove_clips() const;

private:
    std::string stem() const { return root_.stem().string(); }

    std::filesystem::path root_;
};

/// Where the files of a .usda cache are until it is published: skirt.partial.usda, or with clips
/// skirt.partial/skirt.usda.
UsdFiles unfinished_usd(const std::filesystem::path& file, int sample_count);

} // namespace toile::exports
