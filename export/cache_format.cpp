#include "export/cache_format.h"

#include <string>

#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_path.h"

namespace toile::exports {

CacheFormat cache_format(const std::filesystem::path& file)
{
    const std::string extension = lower_case_extension(archive_of(file));
    if (extension == ".pc2")
        return CacheFormat::Pc2;
    if (extension == ".mdd")
        return CacheFormat::Mdd;
    if (extension == ".abc")
        return CacheFormat::Abc;
    if (extension == ".obj")
        return CacheFormat::Obj;
    if (extension == ".ply")
        return CacheFormat::Ply;
    if (extension == ".glb")
        return CacheFormat::Glb;
    if (extension == ".pvd")
        return CacheFormat::Vtk;
    throw InvalidInput(file.string() + ": unknown cache extension '" + extension +
                       "'; use .pc2, .mdd, .abc, .obj, .ply, .glb or .pvd");
}

bool stores_faces(CacheFormat format) { return format != CacheFormat::Pc2 && format != CacheFormat::Mdd; }

bool stores_times(CacheFormat format)
{
    return format == CacheFormat::Mdd || format == CacheFormat::Abc || format == CacheFormat::Glb ||
           format == CacheFormat::Vtk;
}

bool numbers_frames(CacheFormat format)
{
    return format == CacheFormat::Obj || format == CacheFormat::Ply || format == CacheFormat::Vtk;
}

bool is_read_back(CacheFormat format) { return format != CacheFormat::Glb && format != CacheFormat::Vtk; }

bool holds_several_meshes(CacheFormat format)
{
    return format == CacheFormat::Abc || format == CacheFormat::Glb;
}

} // namespace toile::exports
