#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace toile::preview {

/// Most pixels of an image that is decoded: 8192 x 8192.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t(1) << 26;

/// An image with alpha, rows from the top.
struct DecodedImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba; ///< [height x width x 4]
};

/// Decodes a PNG or JPEG, told apart by its first bytes. Colour profiles and gamma of the file are ignored,
/// as glTF has it.        [glTF 2.0, section 3.8.3]
/// @param place  of the image, begins the message
/// @throws InvalidInput for another format, a damaged or cut-off image, and one of more than kMaxImagePixels;
///         sizes are checked before memory is taken.
DecodedImage decode_image(std::span<const unsigned char> bytes, const std::string& place);

/// Likewise, of one format.
/// @param error  out: what is wrong, empty if the image is whole
void decode_png(std::span<const unsigned char> bytes, DecodedImage& image, std::string& error);
void decode_jpeg(std::span<const unsigned char> bytes, DecodedImage& image, std::string& error);

/// What is wrong with a size; empty if it may be decoded.
std::string size_error(std::uint64_t width, std::uint64_t height);

} // namespace toile::preview
