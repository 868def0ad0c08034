#include "apps/preview/colour_map.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace toile::preview {

namespace {

/// Evenly spaced colours of the published tables, sRGB. Linear in between, they keep within 0.04 of those.
constexpr std::array<std::uint32_t, 16> kViridis{0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e,
                                                 0x2a788e, 0x23888e, 0x1f988b, 0x22a884, 0x35b779, 0x54c568,
                                                 0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725};
constexpr std::array<std::uint32_t, 15> kTurbo{0x30123b, 0x4145ab, 0x4675ed, 0x39a2fc, 0x1bcfd4,
                                               0x24eca6, 0x61fc6c, 0xa4fc3b, 0xd1e834, 0xf3c63a,
                                               0xfe9b2d, 0xf36315, 0xd93806, 0xb11901, 0x7a0402};

Vec3 rgb(std::uint32_t hex) { return Vec3(hex >> 16 & 255, hex >> 8 & 255, hex & 255) / 255.0; }

} // namespace

Vec3 ColourScale::colour(double value) const
{
    const std::span<const std::uint32_t> table =
        map == ColourMap::Viridis ? std::span<const std::uint32_t>(kViridis) : kTurbo;
    const double at = std::clamp((value - low) / (high - low), 0.0, 1.0) * double(table.size() - 1);
    const size_t below = std::min(size_t(at), table.size() - 2);
    const double t = at - double(below);
    return (1.0 - t) * rgb(table[below]) + t * rgb(table[below + 1]);
}

} // namespace toile::preview
