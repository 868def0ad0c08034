#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>
#include <png.h>

#include "apps/preview/paint/decode_image.h"

namespace toile::test {

using Rgba = std::array<std::uint8_t, 4>;
using Bytes = std::vector<unsigned char>;

inline constexpr Rgba kRed{230, 30, 20, 255}, kGreen{20, 190, 30, 255}, kBlue{20, 30, 220, 255},
    kYellow{230, 210, 20, 255};

/// An image of four quarters of `side` x `side` pixels: upper left, upper right, lower left, lower right.
inline preview::DecodedImage quarters(const std::array<Rgba, 4>& colours, int side)
{
    preview::DecodedImage image{2 * side, 2 * side, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Rgba& colour = colours[size_t(2 * (y / side) + x / side)];
            image.rgba.insert(image.rgba.end(), colour.begin(), colour.end());
        }
    return image;
}

inline Bytes png_of(const preview::DecodedImage& image)
{
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = png_uint_32(image.width);
    header.height = png_uint_32(image.height);
    header.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    png_image_write_to_memory(&header, nullptr, &size, 0, image.rgba.data(), 0, nullptr);
    Bytes bytes(size);
    png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgba.data(), 0, nullptr);
    return bytes;
}

inline Bytes jpeg_of(const preview::DecodedImage& image)
{
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = JDIMENSION(image.width);
    jpeg.image_height = JDIMENSION(image.height);
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_EXT_RGBA;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 98, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < image.height; ++y) {
        auto* row = const_cast<unsigned char*>(&image.rgba[4 * size_t(y) * size_t(image.width)]);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    Bytes bytes(memory, memory + size);
    jpeg_destroy_compress(&jpeg);
    std::free(memory);
    return bytes;
}

} // namespace toile::test
