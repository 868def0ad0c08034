#pragma once

#include <cstdio>
#include <filesystem>

#include "apps/render/image.h"

namespace toile {

/// Encodes pictures to an MP4 (H.264, 4:2:0, index in front) by piping them into the ffmpeg program.
/// The file gets its name at finish(); until then, and after a failure, it is skirt.partial.mp4.
class VideoWriter {
public:
    /// @param width, height  of every picture [pixels]; an odd last row or column is dropped
    /// @throws InvalidInput when ffmpeg is not on PATH or the place can't be written.
    VideoWriter(std::filesystem::path file, int width, int height, double fps);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// @throws InvalidInput for a picture of another size, DeviceError when ffmpeg stopped.
    void write(const Image& image);

    /// Waits for ffmpeg and moves the video into place. @throws DeviceError when ffmpeg failed.
    void finish();

private:
    std::filesystem::path file_;
    std::filesystem::path partial_;
    int width_;
    int height_;
    std::FILE* pipe_ = nullptr;
    int process_ = -1;
};

/// True when a program of this name can be run from PATH.
bool is_on_path(const char* program);

} // namespace toile
