#include "export/archive/face_groups.h"

#include <map>
#include <set>

#include "export/archive/names.h"

namespace toile::exports {

std::vector<FaceGroup> face_groups(const ObjMesh& mesh)
{
    std::vector<FaceGroup> groups;
    std::map<std::string, size_t> group_of;
    std::set<std::string> taken;
    for (size_t g = 0; g < mesh.groups.size(); ++g) {
        const ObjGroup& group = mesh.groups[g];
        const int end =
            g + 1 < mesh.groups.size() ? mesh.groups[g + 1].first_polygon : int(mesh.polygons.size());
        if (group.name.empty() || group.first_polygon == end)
            continue;
        const auto [at, is_new] = group_of.try_emplace(group.name, groups.size());
        if (is_new) {
            std::string clean = clean_name(group.name);
            for (int k = 2; !taken.insert(clean).second; ++k)
                clean = clean_name(group.name) + "_" + std::to_string(k);
            groups.push_back({group.name, clean, {}});
        }
        for (int polygon = group.first_polygon; polygon < end; ++polygon)
            groups[at->second].polygons.push_back(polygon);
    }
    return groups;
}

} // namespace toile::exports
