#include "apps/preview/paint/image_texture.h"

#include <algorithm>
#include <cmath>

namespace toile::preview {

namespace {

std::array<double, 256> linear_bytes()
{
    std::array<double, 256> linear{};
    for (size_t byte = 0; byte < linear.size(); ++byte)
        linear[byte] = avatars::linear_from_srgb(double(byte) / 255.0);
    return linear;
}

/// The same place of the image, by a small coordinate; 0 for one that is not finite.
double reduced(double at, avatars::Wrap wrap)
{
    if (!std::isfinite(at))
        return 0.0;
    return wrap == avatars::Wrap::Clamp ? std::clamp(at, 0.0, 1.0) : at - 2.0 * std::floor(0.5 * at);
}

/// Index in an image of `count` pixels of the one at i, which may lie outside.
int wrapped(int i, int count, avatars::Wrap wrap)
{
    switch (wrap) {
    case avatars::Wrap::Clamp:
        return std::clamp(i, 0, count - 1);
    case avatars::Wrap::Mirror: {
        const int in_pair = ((i % (2 * count)) + 2 * count) % (2 * count);
        return in_pair < count ? in_pair : 2 * count - 1 - in_pair;
    }
    case avatars::Wrap::Repeat:
        break;
    }
    return ((i % count) + count) % count;
}

} // namespace

Eigen::Vector4d ImageTexture::pixel(int x, int y) const
{
    static const std::array<double, 256> kLinear = linear_bytes();
    const size_t row = size_t(wrapped(y, image_->height, wrap_[1]));
    const std::uint8_t* rgba =
        &image_->rgba[4 * (row * size_t(image_->width) + size_t(wrapped(x, image_->width, wrap_[0])))];
    return {kLinear[rgba[0]], kLinear[rgba[1]], kLinear[rgba[2]], rgba[3] / 255.0};
}

Eigen::Vector4d ImageTexture::colour(const Vec2& at) const
{
    // Centres of pixels are at halves.
    const double x = reduced(at.x(), wrap_[0]) * image_->width - 0.5;
    const double y = reduced(at.y(), wrap_[1]) * image_->height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const double u = x - left, v = y - top;
    const int i = int(left), j = int(top);
    return (1.0 - v) * ((1.0 - u) * pixel(i, j) + u * pixel(i + 1, j)) +
           v * ((1.0 - u) * pixel(i, j + 1) + u * pixel(i + 1, j + 1));
}

} // namespace toile::preview
