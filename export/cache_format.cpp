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
    if (extension == ".usda" || extension == ".usdc" || extension == ".usd")
        return CacheFormat::Usd;
    if (extension == ".obj")
        return CacheFormat::Obj;
    throw InvalidInput(file.string() + ": unknown cache extension '" + extension +
                       "'; use .pc2, .mdd, .abc, .usda, .usdc or .obj");
}

bool stores_faces(CacheFormat format)
{
    return format == CacheFormat::Obj || format == CacheFormat::Abc || format == CacheFormat::Usd;
}

bool holds_several_meshes(CacheFormat format)
{
    return format == CacheFormat::Abc || format == CacheFormat::Usd;
}

} // namespace toile::exports
