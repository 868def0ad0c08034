#include "scenes/scene_body.h"

#include "scenes/shape_mesh.h"

namespace toile {

SceneBody::SceneBody(const scene::Avatar& settings) : motion_(settings)
{
    if (const Shape* shape = motion_.shape()) {
        const auto* plane = std::get_if<scene::Plane>(&settings.shape);
        surface_ = shape_mesh(*shape, plane != nullptr ? plane->preview_size * settings.scale : 0.0);
        start_surface_ = surface_.positions;
    } else {
        const Figure& figure = *motion_.figure();
        surface_.triangles = figure.triangles();
        if (!is_all_touched())
            contact_.triangles = figure.contact_triangles();
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
    const Figure& figure = *motion_.figure();
    std::vector<Vec3>& touched = is_all_touched() ? surface_.positions : contact_.positions;
    touched.resize(size_t(figure.vertex_count()));
    figure.pose_t1(touched);
    if (!is_all_touched())
        surface_.positions.assign(touched.begin(), touched.begin() + figure.body_vertex_count());
}

std::vector<SceneBody> make_bodies(const Scene& scene)
{
    std::vector<SceneBody> bodies;
    bodies.reserve(scene.avatars.size());
    for (const scene::Avatar& avatar : scene.avatars)
        bodies.emplace_back(avatar);
    return bodies;
}

} // namespace toile
