#include "garment/pattern/mesh/placed_panels.h"

namespace toile::garment {

ObjMesh placed_panels(const Pattern& pattern, const PatternMesh& mesh)
{
    ObjMesh obj;
    obj.texture_coordinates = mesh.uv;
    for (int p = 0; p < mesh.panel_count(); ++p) {
        const Panel& panel = pattern.panels[p];
        begin_group(obj, panel.name, mesh.first_triangle[p]);
        for (int v = mesh.first_vertex[p]; v < mesh.first_vertex[p + 1]; ++v)
            obj.positions.push_back(panel.placement * Vec3(mesh.uv[v].x(), mesh.uv[v].y(), 0.0));
    }
    for (const Triangle& t : mesh.triangles)
        obj.polygons.push_back({t[0], t[1], t[2]});
    obj.polygon_uvs = obj.polygons;
    for (const auto& seam : mesh.stitches)
        obj.lines.insert(obj.lines.end(), seam.begin(), seam.end());
    return obj;
}

} // namespace toile::garment
