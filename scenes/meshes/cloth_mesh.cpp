#include "scenes/meshes/cloth_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/clean.h"
#include "core/mesh/obj.h"
#include "core/mesh/winding.h"
#include "garment/pattern/shapes.h"
#include "scenes/meshes/flat_texture.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/meshes/rigid_motion.h"

namespace toile::scenes {

namespace {

/// Mesh of a cloth's file with Y up, in the cloth's unit.
ObjMesh read_file(const scene::Cloth& cloth)
{
    auto [mesh, axes] = read_mesh_file(std::get<std::filesystem::path>(cloth.shape));
    if (axes) {
        // A unit in the scene replaces that of the file.
        const exports::Axes stored{cloth.unit ? exports::Axes{}.unit : axes->unit, axes->up};
        exports::change_axes(stored, {}, mesh.positions);
    }
    return std::move(mesh);
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
    return read_file(cloth);
}

std::string counted(std::ptrdiff_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Joins seams and drops loose vertices. Cloth needs neither; caches need the file's vertices.
/// @return true if any were joined
bool join_vertices(const scene::Cloth& cloth, ClothMesh& result)
{
    ObjMesh& mesh = result.mesh;
    const int count = int(mesh.positions.size());
    std::vector<int> stands(size_t(count), 0);
    std::iota(stands.begin(), stands.end(), 0);
    if (cloth.weld)
        stands = stitch(mesh, seam_distance(mesh));
    int joined = 0;
    for (int v = 0; v < count; ++v)
        joined += stands[v] != v ? 1 : 0;
    if (joined > 0)
        result.warnings.push_back("joined " + counted(joined, "vertex", "vertices") +
                                  " along edges that lie on " + "others; \"weld\": false keeps them apart");
    require_usable(mesh, source_of(cloth));
    const std::vector<int> number = drop_loose_vertices(mesh);
    if (int(mesh.positions.size()) == count)
        return joined > 0;

    FileNumbers& numbers = result.numbers;
    int last = 0;
    for (int v = 0; v < count; ++v) {
        const int own = number[stands[v]];
        if (own < 0)
            numbers.loose.push_back(v);
        else if (own == int(numbers.file_vertex.size()))
            numbers.file_vertex.push_back(v);
        last = own < 0 ? last : own;
        numbers.vertex.push_back(last);
    }
    if (const std::vector<int>& loose = numbers.loose; !loose.empty())
        result.warnings.push_back(counted(std::ptrdiff_t(loose.size()), "vertex has", "vertices have") +
                                  " no face, the first is " + std::to_string(loose.front()) +
                                  "; each goes along with the one before it");
    return joined > 0;
}

std::string text_of_pair(const ObjMesh& mesh, const std::array<int, 2>& polygons)
{
    const auto number = [&](int polygon) {
        return std::to_string(mesh.polygon_lines.empty() ? polygon : mesh.polygon_lines[size_t(polygon)]);
    };
    return (mesh.polygon_lines.empty() ? "" : "in lines ") + number(polygons[0]) + " and " +
           number(polygons[1]);
}

/// Makes of a file's mesh one that can be simulated, and tells what was changed.
void clean(const scene::Cloth& cloth, ClothMesh& result)
{
    ObjMesh& mesh = result.mesh;
    const ObjMesh file = mesh;
    if (!mesh.lines.empty() && !cloth.sewing) {
        result.warnings.push_back("left out " + counted(std::ptrdiff_t(mesh.lines.size()), "line", "lines") +
                                  " between vertices; \"sewing\": {} sews along them");
        mesh.lines.clear();
    }
    if (mesh.free_form_elements > 0)
        result.warnings.push_back(
            "left out " +
            counted(mesh.free_form_elements, "curve or curved surface", "curves and curved surfaces") +
            "; only polygons are read");
    if (const int count = drop_repeated_corners(mesh); count > 0)
        result.warnings.push_back("left out corners of " + counted(count, "face", "faces") +
                                  " that repeat the one before");
    if (const int count = drop_repeated_polygons(mesh); count > 0)
        result.warnings.push_back("left out " + counted(count, "face", "faces") +
                                  " with the corners of others: duplicates, or backs of two-sided faces");
    const int branching_in_file = branching_edges(mesh);
    const bool is_welded = join_vertices(cloth, result);
    drop_repeated_lines(mesh);
    if (const int count = make_windings_agree(mesh); count > 0)
        result.warnings.push_back("flipped " + counted(count, "face", "faces") +
                                  (count == 1 ? " that was" : " that were") +
                                  " wound against the neighbours");
    if (const int count = branching_edges(mesh); count > 0)
        result.warnings.push_back(counted(count, "edge is", "edges are") +
                                  " shared by more than two faces: the two that continue each other bend " +
                                  "there as one, the others are hinged on them" +
                                  (branching_in_file < count ? "; \"weld\": false keeps seams apart" : ""));
    if (const auto polygons = one_sided_polygons(mesh))
        throw InvalidInput(
            source_of(cloth) + ": the faces " + text_of_pair(mesh, *polygons) +
            " can't be wound alike: the surface has one side only, as a Moebius strip" +
            (is_welded ? "; cut it, or keep its seams apart with \"weld\": false" : "; cut it"));
    if (!result.numbers.vertex.empty() && cloth.subdivide == 0)
        result.file = file;
}

/// Makes the cut mesh one that can be simulated, still in the cloth's local frame.
void prepare(const scene::Cloth& cloth, ClothMesh& result)
{
    if (std::holds_alternative<std::filesystem::path>(cloth.shape))
        clean(cloth, result);
    else
        require_usable(result.mesh, source_of(cloth));
}

/// Subdivides, scales and rotates it.
void place(const scene::Cloth& cloth, ClothMesh& result)
{
    if (cloth.subdivide > 0)
        result.mesh = subdivide(result.mesh, cloth.subdivide);
    const Mat3 rotation = rotation_of(cloth.rotate_deg);
    for (ObjMesh* mesh : {&result.mesh, &result.file}) {
        for (Vec3& p : mesh->positions)
            p = rotation *
                (cloth.scale * scene::metres_per(cloth.unit.value_or(scene::LengthUnit::Metre)) * p);
        require_in_range(mesh->positions, source_of(cloth));
    }
}

std::string text_of(const std::vector<int>& polygon)
{
    std::string text;
    for (const int v : polygon)
        text += (text.empty() ? "" : " ") + std::to_string(v + 1);
    return text;
}

/// Replaces the texture of a cloth's mesh, as in its file, by that of a mesh with the same faces.
/// @throws InvalidInput naming the first face that differs
void take_texture(ObjMesh rest, const scene::Cloth& cloth, ObjMesh& mesh)
{
    const std::string source = rest_source_of(cloth), remedy = "; a rest file has the faces of the cloth's";
    const size_t common = std::min(rest.polygons.size(), mesh.polygons.size());
    for (size_t f = 0; f < common; ++f)
        if (rest.polygons[f] != mesh.polygons[f])
            throw InvalidInput(name_of_face(rest, int(f), source) + ": the face has vertices " +
                               text_of(rest.polygons[f]) + ", but " + text_of(mesh.polygons[f]) + " in " +
                               name_of_face(mesh, int(f), source_of(cloth)) + remedy);
    if (rest.polygons.size() != mesh.polygons.size())
        throw InvalidInput(source + ": has " +
                           counted(std::ptrdiff_t(rest.polygons.size()), "face", "faces") + ", but " +
                           source_of(cloth) + " has " + std::to_string(mesh.polygons.size()) + remedy);
    mesh.texture_coordinates = std::move(rest.texture_coordinates);
    mesh.polygon_uvs = std::move(rest.polygon_uvs);
    mesh.polygon_lines = std::move(rest.polygon_lines);
    mesh.first_plain_line = rest.first_plain_line;
}

} // namespace

std::string source_of(const scene::Cloth& cloth)
{
    const auto* file = std::get_if<std::filesystem::path>(&cloth.shape);
    return file ? file->string() : "cloth \"" + cloth.name + "\"";
}

std::string rest_source_of(const scene::Cloth& cloth)
{
    return cloth.rest_file ? cloth.rest_file->string() : source_of(cloth);
}

ClothMesh cloth_mesh(const scene::Cloth& cloth)
{
    ClothMesh result;
    result.mesh = cut(cloth);
    prepare(cloth, result);
    if (cloth.rest == scene::RestFrom::Uv && !cloth.rest_file)
        require_flat_texture(result.mesh, source_of(cloth));
    place(cloth, result);
    return result;
}

ObjMesh mesh_at_rest(const scene::Cloth& cloth)
{
    ClothMesh result;
    result.mesh = cut(cloth);
    take_texture(read_mesh_file(*cloth.rest_file).mesh, cloth, result.mesh);
    prepare(cloth, result);
    require_flat_texture(result.mesh, rest_source_of(cloth));
    place(cloth, result);
    return std::move(result.mesh);
}

} // namespace toile::scenes
