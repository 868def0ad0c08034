#pragma once

#include <filesystem>

#include "export/cache_writer.h"
#include "export/frame_order.h"
#include "export/obj/obj_sequence.h"

namespace toile::exports {

/// Writes one frame as an OBJ with the polygons and texture coordinates of the layout.
class ObjWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    ObjWriter(std::filesystem::path file, const CacheLayout& layout);

    void write(int frame, View<const Vec3> positions) override;
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return partial_; }

private:
    std::filesystem::path file_;
    std::filesystem::path partial_;
    FrameOrder order_;
    ObjMesh mesh_;
};

/// Writes every frame as an OBJ, numbered from the layout's start frame. The frames are stored in a folder
/// skirt.partial/. publish() moves them out and removes frames of an earlier, longer run that would continue
/// the sequence.
class ObjSequenceWriter final : public CacheWriter {
public:
    /// @throws InvalidInput as make_cache_writer().
    ObjSequenceWriter(const std::filesystem::path& pattern, const CacheLayout& layout);

    void write(int frame, View<const Vec3> positions) override;
    std::filesystem::path complete() override;
    void publish() override;
    std::filesystem::path partial() const override { return folder_; }

private:
    int number(int frame) const { return first_number_ + frame; }
    void require_earlier_frames(int frames) const;
    void remove_other_frames();

    ObjSequence sequence_;
    std::filesystem::path folder_;
    std::filesystem::path waiting_pattern_;
    ObjSequence waiting_; ///< in folder_
    FrameOrder order_;
    int first_number_;
    int frame_count_;
    int resume_at_;
    ObjMesh mesh_;
};

} // namespace toile::exports
