#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "apps/preview/image.h"
#include "core/base/error.h"

namespace toile::preview {

namespace {

constexpr int kGap = 8;                 ///< [pixels] between pictures
constexpr std::uint8_t kGapShade = 250; ///< near white
constexpr std::array<std::uint8_t, 3> kInk{60, 64, 72};

/// Digits of 3 x 5 dots, one row per 3 bits, the top row first.
constexpr std::array<std::uint16_t, 10> kDigits{
    0b111101101101111, 0b010110010010111, 0b111001111100111, 0b111001111001111, 0b101101111001001,
    0b111100111001111, 0b111100111101111, 0b111001010010010, 0b111101111101111, 0b111101111001111};

void draw_number(Image& sheet, int left, int bottom, int dot, int number)
{
    for (const char digit : std::to_string(std::max(number, 0))) {
        const std::uint16_t dots = kDigits[size_t(digit - '0')];
        for (int y = 0; y < 5 * dot; ++y)
            for (int x = 0; x < 3 * dot; ++x)
                if (dots >> (14 - 3 * (y / dot) - x / dot) & 1)
                    std::copy(kInk.begin(), kInk.end(), sheet.pixel(left + x, bottom - 5 * dot + y));
        left += 4 * dot;
    }
}

void require_sheet(std::span<const Image> images, int columns, std::span<const int> frame_numbers)
{
    if (images.empty() || columns < 1)
        throw InvalidInput("contact sheet of " + std::to_string(images.size()) + " pictures in " +
                           std::to_string(columns) + " columns; both must be 1 or more");
    for (const Image& image : images)
        if (image.width != images[0].width || image.height != images[0].height)
            throw InvalidInput("contact sheet: a picture is " + std::to_string(image.width) + " x " +
                               std::to_string(image.height) + " pixels, the first " +
                               std::to_string(images[0].width) + " x " + std::to_string(images[0].height) +
                               "; all must be of one size");
    if (!frame_numbers.empty() && frame_numbers.size() < images.size())
        throw InvalidInput("contact sheet: " + std::to_string(frame_numbers.size()) + " numbers for " +
                           std::to_string(images.size()) + " pictures; give one each or none");
}

} // namespace

Image contact_sheet(std::span<const Image> images, int columns, std::span<const int> frame_numbers)
{
    require_sheet(images, columns, frame_numbers);
    const int width = images[0].width, height = images[0].height;
    columns = std::min(columns, int(images.size()));
    const int rows = (int(images.size()) + columns - 1) / columns;
    Image sheet(columns * (width + kGap) - kGap, rows * (height + kGap) - kGap);
    std::fill(sheet.rgb.begin(), sheet.rgb.end(), kGapShade);

    const int dot = std::max(1, height / 160);
    for (int i = 0; i < int(images.size()); ++i) {
        const int left = i % columns * (width + kGap), top = i / columns * (height + kGap);
        for (int y = 0; y < height; ++y)
            std::copy_n(images[size_t(i)].pixel(0, y), 3 * width, sheet.pixel(left, top + y));
        const bool fits = width > 44 * dot && height > 9 * dot; // ten digits
        if (!frame_numbers.empty() && fits)
            draw_number(sheet, left + 3 * dot, top + height - 3 * dot, dot, frame_numbers[size_t(i)]);
    }
    return sheet;
}

} // namespace toile::preview
