#include "apps/preview/render_scene.h"

namespace toile::preview {

Material cloth_material(const Vec3& front)
{
    Material material;
    material.front = front;
    material.back = 0.55 * front + 0.30 * Vec3::Ones();
    material.sheen = 0.35;
    material.translucency = 0.12;
    material.print_front = 0.12 * front + 0.80 * Vec3::Ones();
    return material;
}

Material mannequin_material()
{
    Material material;
    material.front = material.back = Vec3(0.80, 0.72, 0.65);
    material.gloss = 0.25;
    return material;
}

std::vector<std::array<Vec2, 3>> corner_coordinates(View<const Triangle> triangles, View<const Vec2> rest)
{
    std::vector<std::array<Vec2, 3>> corners;
    for (const Triangle& t : triangles)
        corners.push_back({rest[t[0]], rest[t[1]], rest[t[2]]});
    return corners;
}

} // namespace toile::preview
