#include "export/cache_format.h"

#include <string>

#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_path.h"

namespace toile::exports {

const std::vector<std::string>& cache_extensions()
{
    static const std::vector<std::string> kExtensions{".pc2", ".mdd", ".obj", ".abc"};
    return kExtensions;
}

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
    throw InvalidInput(file.string() + ": unknown cache extension '" + extension +
                       "'; use .pc2, .mdd, .abc or .obj");
}

bool stores_faces(CacheFormat format) { return format == CacheFormat::Obj || format == CacheFormat::Abc; }

bool holds_several_meshes(CacheFormat format) { return format == CacheFormat::Abc; }

bool stores_normals(CacheFormat format) { return format == CacheFormat::Abc; }

bool has_time_line(CacheFormat format) { return format == CacheFormat::Abc; }

bool is_numbered(CacheFormat format) { return format == CacheFormat::Obj; }

} // namespace toile::exports
