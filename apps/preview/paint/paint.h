#pragma once

#include <optional>
#include <vector>

#include "apps/preview/paint/image_texture.h"
#include "avatars/model/appearance.h"

namespace toile::preview {

/// Colours of a surface by the file of its body, in pictures.
class Paint {
public:
    /// Decodes the images that the materials use.
    /// @param plain  linear RGB where the file has no colour
    Paint(avatars::Appearance appearance, const Vec3& plain);

    /// Without images; those that can't be decoded are told in `left_out` too.
    const avatars::Appearance& appearance() const { return appearance_; }

    /// True if parts of the surface may be missing where alpha is low.
    bool has_gaps() const { return has_gaps_; }

    /// Linear RGB [-] at a point of a triangle; none where nothing is.
    /// @param weight  barycentric
    std::optional<Vec3> colour(int triangle, const Vec3& weight) const;

private:
    /// A material with its image.
    struct Coat {
        Eigen::Vector4d factor = Eigen::Vector4d::Ones(); ///< linear RGB and alpha
        double cutoff = 0.0;
        int texture = -1; ///< in textures_
    };

    avatars::Appearance appearance_;
    std::vector<ImageTexture> textures_;
    std::vector<Coat> coats_; ///< [materials + 1] the last for triangles without material
    bool has_gaps_ = false;
};

} // namespace toile::preview
