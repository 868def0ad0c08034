#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace toile::preview {

/// A picture of 8-bit sRGB pixels, rows from the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb; ///< [height x width x 3]

    Image() = default;
    Image(int columns, int rows) : width(columns), height(rows), rgb(3 * size_t(columns) * size_t(rows)) {}

    std::uint8_t* pixel(int x, int y) { return &rgb[3 * (size_t(y) * size_t(width) + size_t(x))]; }
    const std::uint8_t* pixel(int x, int y) const
    {
        return &rgb[3 * (size_t(y) * size_t(width) + size_t(x))];
    }
};

/// Writes an 8-bit RGB PNG; the file appears complete or not at all.
/// @throws InvalidInput if the file can't be created, DeviceError if writing fails later.
void write_png(const std::filesystem::path& file, const Image& image);

/// Arranges pictures of equal size in a grid, `columns` to a row, with a gap between them.
/// @param frame_numbers  drawn into the lower left corner of each picture; empty for none
/// @throws InvalidInput for no picture, pictures of different sizes, a wrong count of numbers, or columns <
///         1.
Image contact_sheet(std::span<const Image> images, int columns, std::span<const int> frame_numbers = {});

} // namespace toile::preview
