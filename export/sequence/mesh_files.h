#pragma once

#include <filesystem>
#include <functional>

#include "export/cache_writer.h"
#include "export/frame_order.h"
#include "export/sequence/numbered_files.h"

namespace toile::exports {

/// Writes a frame with the faces of its layout to a file, which appears complete or not at all.
using MeshFileWriter = std::function<void(const std::filesystem::path& file, const SampleView& sample)>;

/// Writes a cache of one frame as one file.
class MeshFileCache final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    MeshFileCache(std::filesystem::path file, const CacheLayout& layout, MeshFileWriter write_mesh);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return partial_; }
    int readable_samples() const override { return order_.next(); }

private:
    std::filesystem::path file_;
    std::filesystem::path partial_;
    FrameOrder order_;
    MeshFileWriter write_mesh_;
};

/// Writes every frame as a file, numbered from the layout's start frame. The frames are stored in a folder
/// skirt.partial/. publish() moves them out and removes frames of an earlier, longer run that would continue
/// the sequence.
class MeshSequenceCache final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    MeshSequenceCache(const std::filesystem::path& pattern, const CacheLayout& layout,
                      MeshFileWriter write_mesh);

    void write(int frame, const SampleView& sample) override;
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return sequence_.unfinished_folder(); }
    int readable_samples() const override { return order_.next(); }

    /// Name of a frame's file before publish().
    std::filesystem::path unfinished_file(int frame) const { return unfinished_.file(number(frame)); }

private:
    int number(int frame) const { return first_number_ + frame; }
    void require_earlier_frames(int frames) const;
    void remove_other_frames();

    NumberedFiles sequence_, unfinished_;
    FrameOrder order_;
    int first_number_;
    int frame_count_;
    int resume_at_;
    MeshFileWriter write_mesh_;
};

} // namespace toile::exports
