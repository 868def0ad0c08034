#include "scenes/meshes/mesh_file.h"

#include "core/base/error.h"
#include "export/point_cache.h"
#include "scenes/format/cache_files.h"

namespace toile::scenes {

MeshFile read_mesh_file(const std::filesystem::path& file)
{
    if (!scene_format::is_cache(file))
        return {read_obj(file), std::nullopt};
    const exports::PointCache cache = exports::read_cache(file);
    if (cache.mesh() == nullptr)
        throw InvalidInput(file.string() + ": has no faces; name the OBJ on which it plays");
    MeshFile result{*cache.mesh(), cache.axes()};
    require_in_range(result.mesh.positions, file.string());
    return result;
}

std::string name_of_face(const ObjMesh& mesh, int polygon, const std::string& source)
{
    return mesh.polygon_lines.empty() ? source + " (face " + std::to_string(polygon) + ")"
                                      : source + ":" + std::to_string(mesh.polygon_lines[size_t(polygon)]);
}

} // namespace toile::scenes
