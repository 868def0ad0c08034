#include "scenes/surfaces/load_soft_bodies.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "core/base/extension.h"
#include "core/mesh/clean.h"
#include "core/mesh/obj.h"
#include "core/mesh/weld.h"
#include "scenes/meshes/rigid_motion.h"
#include "volume/mesh/msh.h"
#include "volume/mesh/vertex_order.h"
#include "volume/mesh/vtk.h"
#include "volume/meshing/fill_surface.h"

namespace toile::scenes {

namespace {

/// A body in its own axes [m].
struct RestMesh {
    volume::TetMesh tets;
    std::vector<Triangle> surface;
    std::vector<int> of_file; ///< see LoadedSoftBody
};

/// Numbers the vertices of the surface first, both parts in volume::vertex_order().
RestMesh with_surface_first(volume::TetMesh mesh)
{
    std::vector<Triangle> surface = volume::boundary_triangles(mesh.tets);
    std::vector<char> is_on_surface(mesh.positions.size(), 0);
    for (const Triangle& face : surface)
        for (const int v : face)
            is_on_surface[v] = 1;
    const std::vector<int> order = volume::vertex_order(mesh);
    int next = 0;
    std::vector<int> number(mesh.positions.size());
    std::vector<Vec3> positions(mesh.positions.size());
    for (const char part : {1, 0})
        for (const int v : order)
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
    return {std::move(mesh), std::move(surface), std::move(number)};
}

std::string source_of(const scene::SoftBody& body)
{
    return body.file ? body.file->string() : "avatar \"" + body.core->avatar + "\"";
}

/// A surface to fill [m].
TriangleMesh surface_of(const scene::SoftBody& body, double scale, const std::vector<Collider>& colliders)
{
    if (!body.file) {
        const collision::MeshCollider& mesh =
            *colliders[index_of(colliders, body.core->avatar)].contact_collider().mesh;
        const View<const Vec3> x = mesh.x_t1();
        const View<const Triangle> triangles = mesh.triangles();
        return weld({{x.begin(), x.end()}, {triangles.begin(), triangles.end()}}, 0.0).mesh;
    }
    TriangleMesh surface = stitched_surface(read_obj(*body.file));
    for (Vec3& p : surface.positions)
        p *= scale;
    return surface;
}

volume::TetMesh tets_of(const scene::SoftBody& body, double scale, const std::vector<Collider>& colliders)
{
    if (body.cell) {
        const TriangleMesh surface = surface_of(body, scale, colliders);
        require_usable(surface, source_of(body));
        return volume::fill_surface(surface, *body.cell, source_of(body));
    }
    volume::TetMesh tets = lower_case_extension(*body.file) == ".msh" ? volume::read_msh_tets(*body.file)
                                                                      : volume::read_vtk_tets(*body.file);
    for (Vec3& p : tets.positions)
        p *= scale;
    return tets;
}

Vec3 placed(const Vec3& p, const scene::SoftBody& body, const Mat3& rotation)
{
    return body.translate + rotation * p;
}

RenderSurface render_surface(const scene::SoftBody& body, double scale, const volume::TetMesh& rest)
{
    const std::string source = body.render->string();
    ObjMesh mesh = read_obj(*body.render);
    require_usable(mesh, source);
    for (Vec3& p : mesh.positions)
        p *= scale;
    EmbeddedSurface embedding(mesh.positions, rest, source);
    const Mat3 rotation = rotation_of(body.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = placed(p, body, rotation);
    ClothState state;
    state.name = body.render_name();
    state.positions = mesh.positions;
    state.triangles = mesh.triangulated().triangles;
    state.rest = std::move(mesh);
    return {std::move(state), std::move(embedding)};
}

LoadedSoftBody placed(const scene::SoftBody& body, const RestMesh& rest)
{
    LoadedSoftBody loaded{source_of(body), {}, rest.tets, {}, rest.of_file, {}};
    const Mat3 rotation = rotation_of(body.rotate_deg);
    for (const Vec3& p : rest.tets.positions)
        loaded.positions.push_back(placed(p, body, rotation));
    require_in_range(loaded.positions, loaded.source);

    TriangleMesh surface{{}, rest.surface};
    int vertices = 0;
    for (const Triangle& face : surface.triangles)
        vertices = std::max(vertices, face.maxCoeff() + 1);
    surface.positions.assign(loaded.positions.begin(), loaded.positions.begin() + vertices);
    loaded.surface.name = body.name;
    loaded.surface.rest = faces_of(surface);
    loaded.surface.positions = std::move(surface.positions);
    loaded.surface.triangles = std::move(surface.triangles);
    loaded.surface.fabric.strain_limit = std::numeric_limits<double>::infinity();
    return loaded;
}

} // namespace

std::vector<LoadedSoftBody> load_soft_bodies(const std::vector<scene::SoftBody>& bodies,
                                             const std::vector<Collider>& colliders)
{
    std::map<std::tuple<std::string, double, double>, RestMesh> known;
    std::vector<LoadedSoftBody> loaded;
    for (const scene::SoftBody& body : bodies) {
        const double scale = body.scale * scene::metres_per(body.unit);
        const auto [entry, is_new] = known.try_emplace({source_of(body), scale, body.cell.value_or(0.0)});
        if (is_new)
            entry->second = with_surface_first(tets_of(body, scale, colliders));
        loaded.push_back(placed(body, entry->second));
        if (body.render)
            loaded.back().render = render_surface(body, scale, entry->second.tets);
    }
    return loaded;
}

} // namespace toile::scenes
