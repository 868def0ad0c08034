#include "apps/preview/lettering.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace toile::preview {

namespace {

constexpr std::array<std::uint8_t, 3> kInk{60, 64, 72};

// Letters of 5 x 7 dots: 35 bits, row by row, the upper left dot first.
constexpr std::string_view kMarkNames = ".,-+%/<>()";
constexpr std::array<std::uint64_t, 10> kMarks{0x00000018c, 0x000003188, 0x0000f0000, 0x0084f9080,
                                               0x672222273, 0x044222110, 0x088882082, 0x208208888,
                                               0x088842082, 0x208210888};
constexpr std::array<std::uint64_t, 10> kDigits{0x3a33ae62e, 0x11842108e, 0x3a213221f, 0x3a213062e,
                                                0x08ca97c42, 0x7e1e0862e, 0x3a10f462e, 0x7c2211084,
                                                0x3a317462e, 0x3a317842e};
constexpr std::array<std::uint64_t, 26> kSmall{
    0x000e0be2f, 0x421e8c63e, 0x000e8c22e, 0x042f8c62f, 0x000e8fe0e, 0x191e42108, 0x01f18bc2e,
    0x421e8c631, 0x100c2108e, 0x080610a4c, 0x4212a6292, 0x30842108e, 0x001aad6b5, 0x001e8c631,
    0x000e8c62e, 0x001e8fa10, 0x000f8bc21, 0x0016cc210, 0x000f8383e, 0x211e42126, 0x00118c66d,
    0x00118c544, 0x00118d6aa, 0x001151151, 0x02318bc2e, 0x001f1111f};
constexpr std::array<std::uint64_t, 26> kCapitals{
    0x3a31fc631, 0x7a31f463e, 0x3a308422e, 0x7a318c63e, 0x7e10f421f, 0x7e10f4210, 0x3a30bc62e,
    0x4631fc631, 0x38842108e, 0x1c4210a4c, 0x4654c5251, 0x42108421f, 0x4775ac631, 0x47359c631,
    0x3a318c62e, 0x7a31f4210, 0x3a318d64d, 0x7a31f5251, 0x3e107043e, 0x7c8421084, 0x46318c62e,
    0x46318c544, 0x4631ad771, 0x462a22a31, 0x462a21084, 0x7c222221f};

std::uint64_t dots_of(char letter)
{
    if (letter >= '0' && letter <= '9')
        return kDigits[size_t(letter - '0')];
    if (letter >= 'a' && letter <= 'z')
        return kSmall[size_t(letter - 'a')];
    if (letter >= 'A' && letter <= 'Z')
        return kCapitals[size_t(letter - 'A')];
    const size_t mark = kMarkNames.find(letter);
    return mark == std::string_view::npos ? 0 : kMarks[mark];
}

void draw_dot(Image& image, int left, int top, int dot)
{
    for (int y = std::max(top, 0); y < std::min(top + dot, image.height); ++y)
        for (int x = std::max(left, 0); x < std::min(left + dot, image.width); ++x)
            std::copy(kInk.begin(), kInk.end(), image.pixel(x, y));
}

} // namespace

void draw_text(Image& image, int x, int y, int dot, std::string_view text)
{
    constexpr int kColumns = kLetterWidth - 1, kDots = kColumns * kLetterHeight;
    for (const char letter : text) {
        const std::uint64_t dots = dots_of(letter);
        for (int i = 0; i < kDots; ++i)
            if (dots >> (kDots - 1 - i) & 1)
                draw_dot(image, x + i % kColumns * dot, y + i / kColumns * dot, dot);
        x += kLetterWidth * dot;
    }
}

} // namespace toile::preview
