#include "export/cache_format.h"

#include <map>

#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_path.h"

namespace toile::exports {

const std::vector<std::string>& cache_extensions()
{
    static const std::vector<std::string> kExtensions{".pc2", ".mdd", ".abc", ".usda", ".obj"};
    return kExtensions;
}

std::optional<CacheFormat> known_cache_format(const std::filesystem::path& file)
{
    static const std::map<std::string, CacheFormat> kFormats{
        {".pc2", CacheFormat::Pc2},  {".mdd", CacheFormat::Mdd},  {".abc", CacheFormat::Abc},
        {".usda", CacheFormat::Usd}, {".usdc", CacheFormat::Usd}, {".usd", CacheFormat::Usd},
        {".obj", CacheFormat::Obj}};
    const auto at = kFormats.find(lower_case_extension(archive_of(file)));
    return at == kFormats.end() ? std::nullopt : std::optional(at->second);
}

CacheFormat cache_format(const std::filesystem::path& file)
{
    const std::optional<CacheFormat> format = known_cache_format(file);
    if (!format)
        throw InvalidInput(file.string() + ": unknown cache extension '" +
                           lower_case_extension(archive_of(file)) +
                           "'; use .pc2, .mdd, .abc, .usda, .usdc or .obj");
    return *format;
}

CacheFeatures features_of(CacheFormat format)
{
    switch (format) {
    case CacheFormat::Pc2:
    case CacheFormat::Mdd:
        break;
    case CacheFormat::Abc:
    case CacheFormat::Usd:
        return {.faces = true, .several = true, .normals = true, .time_line = true};
    case CacheFormat::Obj:
        return {.faces = true, .numbered = true};
    }
    return {};
}

} // namespace toile::exports
