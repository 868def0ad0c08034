#include "apps/preview/lettering.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace toile::preview {

namespace {

constexpr std::array<std::uint8_t, 3> kInk{60, 64, 72};

// Letters of 5 x 9 dots: 45 bits, row by row, the upper left dot first. The last two rows are below the line.
constexpr std::string_view kMarkNames = ".,-+%/<>()";
constexpr std::array<std::uint64_t, 10> kMarks{0x000000063000, 0x000000063088, 0x00003c000000, 0x00213e420000,
                                               0x19c88889cc00, 0x011088844000, 0x022220820800, 0x082082222000,
                                               0x022210820800, 0x082084222000};
constexpr std::array<std::uint64_t, 10> kDigits{
    0x0e8ceb98b800, 0x046108423800, 0x0e884c887c00, 0x0e884c18b800, 0x0232a5f10800,
    0x1f878218b800, 0x0e843d18b800, 0x1f0884421000, 0x0e8c5d18b800, 0x0e8c5e10b800};
constexpr std::array<std::uint64_t, 26> kSmall{
    0x000382f8bc00, 0x1087a318f800, 0x0003a308b800, 0x010be318bc00, 0x0003a3f83800, 0x064790842000,
    0x0003e318bc2e, 0x1087a318c400, 0x040308423800, 0x020184210a4c, 0x1084a98a4800, 0x0c2108423800,
    0x0006ab5ad400, 0x0007a318c400, 0x0003a318b800, 0x0007a318fa10, 0x0003e318bc21, 0x0005b3084000,
    0x0003e0e0f800, 0x084790849800, 0x00046319b400, 0x000463151000, 0x0004635aa800, 0x000454454400,
    0x00046318bc2e, 0x0007c4447c00};
constexpr std::array<std::uint64_t, 26> kCapitals{
    0x0e8c7f18c400, 0x1e8c7d18f800, 0x0e8c2108b800, 0x1e8c6318f800, 0x1f843d087c00, 0x1f843d084000,
    0x0e8c2f18b800, 0x118c7f18c400, 0x0e2108423800, 0x071084293000, 0x119531494400, 0x108421087c00,
    0x11dd6b18c400, 0x11cd6718c400, 0x0e8c6318b800, 0x1e8c7d084000, 0x0e8c63593400, 0x1e8c7d494400,
    0x0f841c10f800, 0x1f2108421000, 0x118c6318b800, 0x118c63151000, 0x118c6b5dc400, 0x118a88a8c400,
    0x118a88421000, 0x1f0888887c00};

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
