#include "apps/toile/cloth/skin.h"

namespace toile::app {

TriangleMesh skin_of(const std::vector<scenes::SceneBody>& bodies)
{
    TriangleMesh skin;
    for (const scenes::SceneBody& body : bodies)
        if (!std::holds_alternative<scene::Plane>(body.settings().shape))
            append(skin, body.surface().positions, body.surface().triangles);
    return skin;
}

void append(TriangleMesh& mesh, View<const Vec3> positions, View<const Triangle> triangles)
{
    const int first = mesh.vertex_count();
    mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
    for (const Triangle& t : triangles)
        mesh.triangles.push_back(Triangle(t[0] + first, t[1] + first, t[2] + first));
}

} // namespace toile::app
