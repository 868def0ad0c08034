#include "scenes/drape/dressed_body.h"

#include <memory>

#include "avatars/load_avatar.h"
#include "core/base/error.h"

namespace toile::scenes {

DressedBody::DressedBody(const scene::Avatar& body, bool needs_segments)
{
    avatars::AvatarSettings settings;
    if (const auto* file = std::get_if<std::filesystem::path>(&body.shape))
        settings.file = *file;
    else if (!std::holds_alternative<scene::Mannequin>(body.shape))
        return;
    const std::unique_ptr<avatars::Avatar> avatar = avatars::load_avatar(settings);
    skin.triangles = avatar->triangles();
    skin.positions.resize(size_t(avatar->vertex_count()));
    avatar->pose({}, avatars::identity_affine(), skin.positions);
    try {
        segments = avatars::find_segments(*avatar, {}, avatars::identity_affine()).segments;
    } catch (const InvalidInput&) {
        if (needs_segments)
            throw;
    }
}

} // namespace toile::scenes
