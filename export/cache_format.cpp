#include "export/cache_format.h"

#include <map>

#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_path.h"

namespace toile::exports {

namespace {

/// .pc2, .mdd or .abc
std::string choice_of(const std::vector<std::string>& extensions)
{
    std::string text;
    for (size_t k = 0; k < extensions.size(); ++k)
        text += (k == 0 ? "" : k + 1 < extensions.size() ? ", " : " or ") + extensions[k];
    return text;
}

[[noreturn]] void refuse_unknown(const std::filesystem::path& file, const std::vector<std::string>& known)
{
    throw InvalidInput(file.string() + ": unknown cache extension '" +
                       lower_case_extension(archive_of(file)) + "'; use " + choice_of(known));
}

} // namespace

const std::vector<std::string>& written_extensions()
{
    static const std::vector<std::string> kExtensions{".pc2", ".mdd", ".abc", ".usda", ".usdc",
                                                      ".obj", ".ply", ".glb", ".pvd"};
    return kExtensions;
}

const std::vector<std::string>& read_extensions()
{
    static const std::vector<std::string> kExtensions{".pc2",  ".mdd", ".abc", ".usda",
                                                      ".usdc", ".usd", ".obj", ".ply"};
    return kExtensions;
}

std::optional<CacheFormat> known_cache_format(const std::filesystem::path& file)
{
    static const std::map<std::string, CacheFormat> kFormats{
        {".pc2", CacheFormat::Pc2},  {".mdd", CacheFormat::Mdd},  {".abc", CacheFormat::Abc},
        {".usda", CacheFormat::Usd}, {".usdc", CacheFormat::Usd}, {".usd", CacheFormat::Usd},
        {".obj", CacheFormat::Obj},  {".ply", CacheFormat::Ply},  {".glb", CacheFormat::Glb},
        {".pvd", CacheFormat::Vtk}};
    const auto at = kFormats.find(lower_case_extension(archive_of(file)));
    return at == kFormats.end() ? std::nullopt : std::optional(at->second);
}

CacheFormat cache_format(const std::filesystem::path& file)
{
    const std::optional<CacheFormat> format = known_cache_format(file);
    if (!format)
        refuse_unknown(file, written_extensions());
    return *format;
}

CacheFormat format_to_read(const std::filesystem::path& file)
{
    const std::optional<CacheFormat> format = known_cache_format(file);
    if (!format)
        refuse_unknown(file, read_extensions());
    if (!features_of(*format).read_back)
        throw InvalidInput(file.string() +
                           ": is written for other programs, and not read as a cache; name the " +
                           choice_of(read_extensions()) + " of the run");
    return *format;
}

CacheFeatures features_of(CacheFormat format)
{
    switch (format) {
    case CacheFormat::Pc2:
        break;
    case CacheFormat::Mdd:
        return {.times = true};
    case CacheFormat::Abc:
    case CacheFormat::Usd:
        return {.faces = true,
                .several = true,
                .normals = true,
                .attributes = true,
                .times = true,
                .time_line = true};
    case CacheFormat::Obj:
        return {.faces = true, .numbered = true};
    case CacheFormat::Ply:
        return {.faces = true, .attributes = true, .numbered = true};
    case CacheFormat::Glb:
        return {.faces = true, .several = true, .times = true, .read_back = false};
    case CacheFormat::Vtk:
        return {.faces = true, .attributes = true, .times = true, .numbered = true, .read_back = false};
    }
    return {};
}

} // namespace toile::exports
