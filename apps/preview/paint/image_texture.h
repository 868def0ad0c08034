#pragma once

#include <array>
#include <memory>

#include "apps/preview/paint/decode_image.h"
#include "avatars/model/appearance.h"

namespace toile::preview {

/// An image that is looked up between its pixels.
class ImageTexture {
public:
    ImageTexture(std::shared_ptr<const DecodedImage> image, std::array<avatars::Wrap, 2> wrap)
        : image_(std::move(image)), wrap_(wrap)
    {
    }

    /// Linear RGB and alpha [-]: the bilinear mean of the four nearest pixels, taken in linear colours.
    /// @param at  from the upper left (0, 0) to the lower right (1, 1); outside by the wrap modes
    Eigen::Vector4d colour(const Vec2& at) const;

private:
    Eigen::Vector4d pixel(int x, int y) const;

    std::shared_ptr<const DecodedImage> image_;
    std::array<avatars::Wrap, 2> wrap_; ///< along u and v
};

} // namespace toile::preview
