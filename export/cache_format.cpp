#include "export/cache_format.h"

#include <string>

#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/alembic/abc_cache.h"

namespace toile::exports {

CacheFormat cache_format(const std::filesystem::path& file)
{
    const std::string extension = lower_case_extension(file);
    if (is_abc(file))
        return CacheFormat::Abc;
    if (extension == ".pc2")
        return CacheFormat::Pc2;
    if (extension == ".mdd")
        return CacheFormat::Mdd;
    if (extension == ".obj")
        return CacheFormat::Obj;
    throw InvalidInput(file.string() + ": unknown cache extension '" + extension +
                       "'; use .pc2, .mdd, .abc or .obj");
}

bool stores_faces(CacheFormat format) { return format == CacheFormat::Obj || format == CacheFormat::Abc; }

} // namespace toile::exports
