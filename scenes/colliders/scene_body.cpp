#include "scenes/colliders/scene_body.h"

#include "core/base/long_work.h"
#include "scenes/meshes/shape_mesh.h"

namespace toile::scenes {

SceneBody::SceneBody(const scene::Avatar& settings) : motion_(settings)
{
    if (const collision::Shape* shape = motion_.shape()) {
        const auto* plane = std::get_if<scene::Plane>(&settings.shape);
        surface_ = shape_mesh(*shape, plane != nullptr ? plane->preview_size * settings.scale : 0.0);
        start_surface_ = surface_.positions;
    } else {
        const SkinnedCollider& skinned = *motion_.skinned();
        surface_.triangles = skinned.triangles();
        if (!is_all_collidable())
            contact_.triangles = skinned.contact_triangles();
    }
    place();
}

bool SceneBody::advance_to(double t)
{
    const bool moved = motion_.advance_to(t);
    if (moved)
        place();
    return moved;
}

void SceneBody::place()
{
    if (motion_.shape()) {
        for (size_t i = 0; i < start_surface_.size(); ++i)
            surface_.positions[i] = motion_.pose() * start_surface_[i];
        return;
    }
    const SkinnedCollider& skinned = *motion_.skinned();
    std::vector<Vec3>& collidable = is_all_collidable() ? surface_.positions : contact_.positions;
    collidable.resize(size_t(skinned.vertex_count()));
    skinned.pose_t1(collidable);
    if (!is_all_collidable())
        surface_.positions.assign(collidable.begin(), collidable.begin() + skinned.body_vertex_count());
}

std::string SceneBody::bone_of(int face) const
{
    const std::shared_ptr<const SkinnedCollider> skinned = motion_.skinned();
    return skinned && face >= 0 ? skinned->avatar().bone_at(skinned->triangles()[size_t(face)][0]) : "";
}

std::vector<SceneBody> make_bodies(const Scene& scene)
{
    std::vector<SceneBody> bodies;
    bodies.reserve(scene.avatars.size());
    for (const scene::Avatar& avatar : scene.avatars) {
        if (replacement_of(scene, avatar.name) != nullptr)
            continue;
        const LongWork::Part part = LongWork::item(bodies.size(), scene.avatars.size());
        bodies.emplace_back(avatar);
        LongWork::update(1.0);
    }
    return bodies;
}

} // namespace toile::scenes
