#include "export/mesh/face_panels.h"

#include <map>

namespace toile::exports {

FacePanels face_panels(const ObjMesh& faces)
{
    FacePanels panels;
    std::map<std::string, int> number_of;
    size_t group = 0;
    std::string name = "other";
    for (size_t p = 0; p < faces.polygons.size(); ++p) {
        for (; group < faces.groups.size() && faces.groups[group].first_polygon <= int(p); ++group)
            name = faces.groups[group].name.empty() ? "other" : faces.groups[group].name;
        const auto [at, is_new] = number_of.try_emplace(name, int(panels.names.size()));
        if (is_new)
            panels.names.push_back(name);
        panels.of_face.push_back(at->second);
    }
    return panels;
}

} // namespace toile::exports
