#include "scenes/meshes/cloth_mesh.h"

#include "core/mesh/winding.h"
#include "garment/pattern/shapes.h"
#include "scenes/meshes/rigid_motion.h"

namespace toile::scenes {

namespace {

ObjMesh faces_of(const TriangleMesh& mesh)
{
    ObjMesh faces;
    faces.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles)
        faces.polygons.push_back({t[0], t[1], t[2]});
    return faces;
}

/// Mesh of the cloth in its local frame, before placement.
ObjMesh cut(const scene::Cloth& cloth)
{
    if (const auto* rectangle = std::get_if<scene::Rectangle>(&cloth.shape))
        return faces_of(garment::cut_rectangle(rectangle->size, rectangle->resolution));
    if (const auto* disc = std::get_if<scene::Disc>(&cloth.shape))
        return faces_of(garment::cut_disc(disc->radius, disc->resolution));
    if (const auto* skirt = std::get_if<scene::Skirt>(&cloth.shape))
        return faces_of(
            garment::cut_skirt({skirt->waist_radius, skirt->hem_radius, skirt->length, skirt->resolution}));
    return read_obj(std::get<std::filesystem::path>(cloth.shape));
}

} // namespace

std::string source_of(const scene::Cloth& cloth)
{
    const auto* file = std::get_if<std::filesystem::path>(&cloth.shape);
    return file ? file->string() : "cloth \"" + cloth.name + "\"";
}

ObjMesh oriented_mesh(const scene::Cloth& cloth, int& flipped_faces)
{
    ObjMesh mesh = cut(cloth);
    flipped_faces = make_windings_agree(mesh);
    require_usable(mesh.triangulated(), source_of(cloth));
    if (cloth.subdivide > 0)
        mesh = faces_of(subdivide(mesh.triangulated(), cloth.subdivide));
    const Mat3 rotation = rotation_of(cloth.rotate_deg);
    for (Vec3& p : mesh.positions)
        p = rotation * (cloth.scale * scene::metres_per(cloth.unit) * p);
    require_in_range(mesh.positions, source_of(cloth));
    return mesh;
}

} // namespace toile::scenes
