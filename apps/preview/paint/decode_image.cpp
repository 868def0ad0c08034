#include "apps/preview/paint/decode_image.h"

#include <algorithm>
#include <array>
#include <new>

#include "core/base/error.h"

namespace toile::preview {

namespace {

constexpr std::array<unsigned char, 4> kPng{0x89, 'P', 'N', 'G'};
constexpr std::array<unsigned char, 3> kJpeg{0xff, 0xd8, 0xff};

template <size_t Size>
bool starts_with(std::span<const unsigned char> bytes, const std::array<unsigned char, Size>& mark)
{
    return bytes.size() >= Size && std::equal(mark.begin(), mark.end(), bytes.begin());
}

} // namespace

std::string size_error(std::uint64_t width, std::uint64_t height)
{
    if (width > 0 && height > 0 && width <= kMaxImagePixels / height)
        return "";
    return "it has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; at most " +
           std::to_string(kMaxImagePixels) + " are read";
}

DecodedImage decode_image(std::span<const unsigned char> bytes, const std::string& place)
{
    const bool is_png = starts_with(bytes, kPng);
    if (!is_png && !starts_with(bytes, kJpeg))
        throw InvalidInput(place + ": is neither PNG nor JPEG; save it as one of them");
    DecodedImage image;
    std::string error;
    try {
        is_png ? decode_png(bytes, image, error) : decode_jpeg(bytes, image, error);
    } catch (const std::bad_alloc&) {
        error = "there is not enough memory";
    }
    if (!error.empty())
        throw InvalidInput(place + ": can't be read as " + (is_png ? "PNG" : "JPEG") + ": " + error);
    return image;
}

} // namespace toile::preview
