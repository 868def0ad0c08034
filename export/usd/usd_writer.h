#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "export/archive/frame_velocities.h"
#include "export/cache_writer.h"
#include "export/frame_order.h"
#include "export/usd/usd_files.h"
#include "export/usd/usd_stage.h"

namespace toile::exports {

/// Writes a cache as USD in text: one .usda of at most kUsdSamplesPerFile samples, else a root .usda and
/// value clips. A clip is complete when it appears, and then the root names it, so memory holds the samples
/// of one clip. A killed run keeps all whole clips, and nothing of a cache without them; keep() writes the
/// rest.
///
/// publish() moves the clips one by one, and then the root. A kill in between, which takes milliseconds,
/// leaves clips of either run. Clips of an earlier, longer run are removed.
class UsdWriter final : public CacheWriter {
public:
    /// @param name  of the prim at the top
    /// @throws InvalidInput as make_cache_writer().
    UsdWriter(std::filesystem::path file, const CacheLayout& layout, const std::string& name);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void keep() override;
    int readable_samples() const override { return readable_; }
    void publish() override;
    std::filesystem::path partial() const override { return unfinished_.root(); }

    /// Removes the partial.
    void remove_partial();

private:
    void add_sample();
    void write_clip();

    UsdFiles files_, unfinished_;
    FrameOrder order_;
    std::string name_;
    CacheLayout layout_; ///< until the first frame
    int clip_count_;     ///< when complete; 0: one file
    FrameVelocities moving_;
    std::optional<UsdStage> stage_; ///< from the first frame on
    std::vector<UsdStage::Clip> clips_;
    int readable_ = 0; ///< samples that the root shows
};

} // namespace toile::exports
