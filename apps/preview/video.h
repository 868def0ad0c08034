#pragma once

#include <cstdio>
#include <filesystem>

#include "apps/preview/image.h"

namespace toile::preview {

/// Encodes pictures to an MP4 (H.264, 4:2:0, index in front) by piping them into the ffmpeg program. Until
/// finish(), and after a failure, the file is named skirt.partial.mp4.
class VideoWriter {
public:
    /// @param width, height  of every picture [pixels]; an odd last row or column is dropped
    /// @throws InvalidInput if ffmpeg is not on PATH or the file can't be created.
    VideoWriter(std::filesystem::path file, int width, int height, double fps);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// @throws InvalidInput for a picture of another size, DeviceError if ffmpeg stopped.
    void write(const Image& image);

    /// Waits for ffmpeg and renames the video. @throws DeviceError if ffmpeg failed.
    void finish();

private:
    std::filesystem::path file_;
    std::filesystem::path partial_;
    int width_;
    int height_;
    std::FILE* pipe_ = nullptr;
    int process_ = -1;
};

/// @throws InvalidInput naming the video if ffmpeg is not on PATH.
void require_encoder(const std::filesystem::path& file);

/// True if a program of this name can be run from PATH.
bool is_on_path(const char* program);

} // namespace toile::preview
