#include "apps/preview/colour_bar.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "apps/preview/lettering.h"

namespace toile::preview {

namespace {

constexpr int kDot = 2;              ///< [pixels] of letters
constexpr int kMargin = 12;          ///< [pixels]
constexpr int kBarWidth = 24;        ///< [pixels]
constexpr int kLegendWidth = 150;    ///< [pixels] of bar, numbers and margins
constexpr std::uint8_t kPaper = 250; ///< near white

/// Four digits: 0.25, 12, 2500.
std::string text_of(double value)
{
    std::array<char, 32> digits;
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 4);
    return {digits.data(), end};
}

int width_of(const std::string& text) { return int(text.size()) * kLetterWidth * kDot; }

/// Steps between the numbers of a range: those that are 1, 2, 2.5 or 5 times a power of ten, if there are.
int steps_of(double range)
{
    for (const int steps : {5, 4, 6}) {
        const double step = range / steps;
        const double digits = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
        for (const double round : {1.0, 2.0, 2.5, 5.0})
            if (std::abs(digits - round) < 1e-6)
                return steps;
    }
    return 5;
}

/// @param left, top, bottom  of the bar [pixels]
void draw_bar(Image& image, int left, int top, int bottom, const Legend& legend)
{
    const ColourScale& scale = legend.scale;
    for (int y = top; y <= bottom; ++y) {
        const double t = double(bottom - y) / (bottom - top);
        const Vec3 colour = scale.colour(scale.low + t * (scale.high - scale.low));
        for (int x = left; x < left + kBarWidth; ++x)
            for (int channel = 0; channel < 3; ++channel)
                image.pixel(x, y)[channel] = std::uint8_t(std::lround(255.0 * colour[channel]));
    }
    const int steps = steps_of(legend.shown_per_value * (scale.high - scale.low));
    for (int k = 0; k <= steps; ++k) {
        const double value = scale.low + (scale.high - scale.low) * k / steps;
        const int y = bottom + (top - bottom) * k / steps;
        draw_text(image, left + kBarWidth + kMargin, y - (kLetterHeight - kBelowLine) * kDot / 2, kDot,
                  text_of(legend.shown_per_value * value) + (k == steps ? " +" : ""));
    }
}

} // namespace

Image with_colour_bar(std::span<const Image> pictures, std::span<const std::string> captions,
                      const Legend& legend)
{
    const Image sheet = contact_sheet(pictures, int(pictures.size()));
    const int head = kLetterHeight * kDot + 2 * kMargin, foot = head;
    Image image(sheet.width + kLegendWidth, sheet.height + head + foot);
    std::fill(image.rgb.begin(), image.rgb.end(), kPaper);
    for (int y = 0; y < sheet.height; ++y)
        std::copy_n(sheet.pixel(0, y), 3 * sheet.width, image.pixel(0, y + head));

    draw_text(image, kMargin, kMargin, kDot, legend.title);
    for (size_t k = 0; k < std::min(pictures.size(), captions.size()); ++k) {
        const int pitch = (sheet.width + 1) / int(pictures.size());
        draw_text(image, int(k) * pitch + (pitch - width_of(captions[k])) / 2, head + sheet.height + kMargin,
                  kDot, captions[k]);
    }
    draw_bar(image, sheet.width + kMargin, head + kMargin, head + sheet.height - kMargin, legend);
    return image;
}

} // namespace toile::preview
