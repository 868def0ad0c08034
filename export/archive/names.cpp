#include "export/archive/names.h"

#include <cctype>
#include <set>

#include "core/base/error.h"

namespace toile::exports {

namespace {

/// Names of meshes below one parent, and of those without and of parents.
void require_distinct_names(const std::filesystem::path& file, const CacheLayout& layout)
{
    std::set<std::string> taken, parents;
    const auto take = [&](const std::string& name) {
        if (!taken.insert(name).second)
            throw InvalidInput(file.string() + ": two meshes would be called \"" + name +
                               "\"; give them names that differ in letters, digits or underscores");
    };
    for (const CacheMesh& mesh : layout.meshes) {
        if (!mesh.parent.empty() && parents.insert(mesh.parent).second)
            take(clean_name(mesh.parent));
        take((mesh.parent.empty() ? "" : clean_name(mesh.parent) + "/") + clean_name(mesh.name));
    }
}

} // namespace

std::string clean_name(const std::string& name)
{
    std::string clean = name;
    for (char& c : clean)
        if (!std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    if (clean.empty() || std::isdigit(static_cast<unsigned char>(clean.front())))
        clean.insert(0, "_");
    return clean;
}

CacheLayout with_names(const std::filesystem::path& file, CacheLayout layout)
{
    for (CacheMesh& mesh : layout.meshes)
        if (mesh.name.empty())
            mesh.name = file.stem().string();
    require_distinct_names(file, layout);
    return layout;
}

} // namespace toile::exports
