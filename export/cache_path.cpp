#include "export/cache_path.h"

#include <algorithm>
#include <cctype>

#include "export/archive/names.h"

namespace toile::exports {

namespace {

/// Where the path of a mesh begins, at its #; the end if there is none.
size_t hash_in(std::string path)
{
    std::transform(path.begin(), path.end(), path.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const std::string archive : {".abc#", ".usda#", ".usdc#", ".usd#"})
        if (const size_t at = path.find(archive); at != std::string::npos)
            return at + archive.size() - 1;
    return path.size();
}

} // namespace

std::filesystem::path archive_of(const std::filesystem::path& cache)
{
    const std::string text = cache.string();
    return text.substr(0, hash_in(text));
}

std::string path_of_mesh(const CacheMesh& mesh)
{
    const std::string name = clean_name(mesh.name);
    return (mesh.parent.empty() ? "" : "/" + clean_name(mesh.parent)) + "/" + name + "/" + name + "Shape";
}

std::string mesh_path_of(const std::filesystem::path& cache)
{
    const std::string text = cache.string();
    const size_t hash = hash_in(text);
    return hash < text.size() ? text.substr(hash + 1) : "";
}

} // namespace toile::exports
