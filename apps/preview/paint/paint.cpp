#include "apps/preview/paint/paint.h"

#include <memory>
#include <utility>

#include "core/base/error.h"

namespace toile::preview {

namespace {

Eigen::Vector4d with_alpha(const Vec3& colour, double alpha)
{
    return {colour[0], colour[1], colour[2], alpha};
}

/// Decoded images, null for those that can't be; that is told once, in `left_out`.
std::vector<std::shared_ptr<const DecodedImage>> decoded(std::vector<avatars::StoredImage>& images,
                                                         std::vector<std::string>& left_out)
{
    std::vector<std::shared_ptr<const DecodedImage>> result;
    for (avatars::StoredImage& stored : images) {
        std::shared_ptr<const DecodedImage>& image = result.emplace_back();
        try {
            if (!stored.bytes.empty()) // else told by the importer
                image = std::make_shared<DecodedImage>(decode_image(stored.bytes, stored.place));
        } catch (const InvalidInput& error) {
            left_out.emplace_back(error.what());
        }
        stored = {};
    }
    images.clear();
    return result;
}

} // namespace

Paint::Paint(avatars::Appearance appearance, const Vec3& plain) : appearance_(std::move(appearance))
{
    const auto images = decoded(appearance_.images, appearance_.left_out);
    for (const avatars::SurfaceMaterial& material : appearance_.materials) {
        Coat& coat = coats_.emplace_back();
        coat.cutoff = material.cutoff;
        const auto image = material.texture ? images[size_t(material.texture->image)] : nullptr;
        if (image) {
            coat.texture = int(textures_.size());
            textures_.emplace_back(image, material.texture->wrap);
        }
        coat.factor = with_alpha(material.colour.value_or(image ? Vec3::Ones() : plain), material.alpha);
        has_gaps_ = has_gaps_ || coat.cutoff > 0.0;
    }
    coats_.push_back({with_alpha(plain, 1.0)});
}

std::optional<Vec3> Paint::colour(int triangle, const Vec3& weight) const
{
    const int material = appearance_.material[size_t(triangle)];
    const Coat& coat = material < 0 ? coats_.back() : coats_[size_t(material)];
    Eigen::Vector4d colour = coat.factor;
    if (!appearance_.colours.empty()) {
        const avatars::CornerColours& c = appearance_.colours[size_t(triangle)];
        colour.array() *= (weight[0] * c[0] + weight[1] * c[1] + weight[2] * c[2]).array();
    }
    if (coat.texture >= 0) {
        const avatars::CornerCoordinates& uv = appearance_.coordinates[size_t(triangle)];
        const Vec2 at = weight[0] * uv[0] + weight[1] * uv[1] + weight[2] * uv[2];
        colour.array() *= textures_[size_t(coat.texture)].colour(at).array();
    }
    if (colour[3] < coat.cutoff)
        return std::nullopt;
    return colour.head<3>();
}

} // namespace toile::preview
