#include "export/mesh/mesh_part.h"

#include <algorithm>

#include "export/mesh/face_panels.h"

namespace toile::exports {

namespace {

/// Numbers indices anew by their places in the ascending list of those in use, which is returned.
std::vector<int> renumber(std::vector<std::vector<int>>& polygons)
{
    std::vector<int> used;
    for (const std::vector<int>& polygon : polygons)
        used.insert(used.end(), polygon.begin(), polygon.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::vector<int>& polygon : polygons)
        for (int& index : polygon)
            index = int(std::lower_bound(used.begin(), used.end(), index) - used.begin());
    return used;
}

} // namespace

std::vector<MeshPart> parts_of(const ObjMesh& faces)
{
    const FacePanels panels = face_panels(faces);
    std::vector<MeshPart> parts;
    for (const std::string& name : panels.names)
        parts.push_back({name, {}, {}});
    for (size_t p = 0; p < faces.polygons.size(); ++p) {
        ObjMesh& part = parts[size_t(panels.of_face[p])].faces;
        part.polygons.push_back(faces.polygons[p]);
        if (!faces.polygon_uvs.empty())
            part.polygon_uvs.push_back(faces.polygon_uvs[p]);
    }
    for (MeshPart& part : parts) {
        part.vertices = renumber(part.faces.polygons);
        for (const int uv : renumber(part.faces.polygon_uvs))
            part.faces.texture_coordinates.push_back(faces.texture_coordinates[size_t(uv)]);
    }
    return parts;
}

} // namespace toile::exports
