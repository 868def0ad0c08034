#include "scenes/surfaces/load_soft_body.h"

#include <algorithm>
#include <limits>

#include "core/base/extension.h"
#include "scenes/meshes/rigid_motion.h"
#include "volume/mesh/msh.h"
#include "volume/mesh/vtk.h"

namespace toile::scenes {

namespace {

/// Numbers the vertices of the surface first; both parts keep their order.
/// @return the surface's triangles
std::vector<Triangle> put_surface_first(volume::TetMesh& mesh)
{
    std::vector<Triangle> surface = volume::boundary_triangles(mesh.tets);
    std::vector<char> is_on_surface(mesh.positions.size(), 0);
    for (const Triangle& face : surface)
        for (const int v : face)
            is_on_surface[v] = 1;
    int next = 0;
    std::vector<int> number(mesh.positions.size());
    std::vector<Vec3> positions(mesh.positions.size());
    for (const char part : {1, 0})
        for (size_t v = 0; v < number.size(); ++v)
            if (is_on_surface[v] == part) {
                positions[next] = mesh.positions[v];
                number[v] = next++;
            }
    mesh.positions = std::move(positions);
    for (volume::Tet& tet : mesh.tets)
        for (int& v : tet)
            v = number[v];
    for (Triangle& face : surface)
        for (int& v : face)
            v = number[v];
    return surface;
}

} // namespace

LoadedSoftBody load_soft_body(const scene::SoftBody& body)
{
    LoadedSoftBody loaded;
    loaded.source = body.file.string();
    loaded.mesh = lower_case_extension(body.file) == ".msh" ? volume::read_msh_tets(body.file)
                                                            : volume::read_vtk_tets(body.file);
    const double scale = body.scale * scene::metres_per(body.unit);
    const Mat3 rotation = rotation_of(body.rotate_deg);
    for (Vec3& p : loaded.mesh.positions)
        p = body.translate + rotation * (scale * p);
    require_in_range(loaded.mesh.positions, loaded.source);

    TriangleMesh surface{{}, put_surface_first(loaded.mesh)};
    int vertices = 0;
    for (const Triangle& face : surface.triangles)
        vertices = std::max(vertices, face.maxCoeff() + 1);
    surface.positions.assign(loaded.mesh.positions.begin(), loaded.mesh.positions.begin() + vertices);
    loaded.surface.name = body.name;
    loaded.surface.rest = faces_of(surface);
    loaded.surface.positions = std::move(surface.positions);
    loaded.surface.triangles = std::move(surface.triangles);
    loaded.surface.fabric.strain_limit = std::numeric_limits<double>::infinity();
    return loaded;
}

} // namespace toile::scenes
