#include "scenes/drape/dressed_body.h"

#include <memory>

#include "core/base/error.h"
#include "scenes/colliders/load_body.h"

namespace toile::scenes {

DressedBody::DressedBody(const scene::Avatar& body, bool needs_segments)
{
    if (!std::holds_alternative<std::filesystem::path>(body.shape) &&
        !std::holds_alternative<scene::Mannequin>(body.shape))
        return;
    const std::unique_ptr<avatars::Avatar> avatar = load_body(body);
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
