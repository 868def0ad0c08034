#include "export/cache_format.h"

#include <string>

#include "core/base/error.h"
#include "core/base/extension.h"

namespace toile::exports {

CacheFormat cache_format(const std::filesystem::path& file)
{
    const std::string extension = lower_case_extension(file);
    if (extension == ".pc2")
        return CacheFormat::Pc2;
    if (extension == ".mdd")
        return CacheFormat::Mdd;
    if (extension == ".obj")
        return CacheFormat::Obj;
    throw InvalidInput(file.string() + ": unknown cache extension '" + extension +
                       "'; use .pc2, .mdd or .obj");
}

} // namespace toile::exports
