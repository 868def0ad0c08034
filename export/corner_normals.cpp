#include "export/corner_normals.h"

#include <map>
#include <utility>

namespace toile::exports {

CornerNormals::CornerNormals(const ObjMesh& faces) : polygons_(faces.polygons)
{
    const bool has_texture = !faces.polygon_uvs.empty();
    std::map<std::pair<int, int>, int> index_of; // by vertex and texture coordinates
    for (size_t p = 0; p < polygons_.size(); ++p) {
        std::vector<int>& indices = indices_.emplace_back();
        for (size_t k = 0; k < polygons_[p].size(); ++k) {
            const std::pair corner(polygons_[p][k], has_texture ? faces.polygon_uvs[p][k] : 0);
            const auto [at, is_new] = index_of.try_emplace(corner, count_);
            count_ += int(is_new);
            indices.push_back(at->second);
        }
    }
}

std::vector<Vec3> CornerNormals::at(View<const Vec3> x) const
{
    std::vector<Vec3> normals(size_t(count_), Vec3::Zero());
    for (size_t p = 0; p < polygons_.size(); ++p) {
        const std::vector<int>& polygon = polygons_[p];
        Vec3 area = Vec3::Zero(); // twice that of the polygon, along its normal
        for (size_t k = 1; k + 1 < polygon.size(); ++k)
            area += (x[polygon[k]] - x[polygon[0]]).cross(x[polygon[k + 1]] - x[polygon[0]]);
        for (const int index : indices_[p])
            normals[size_t(index)] += area;
    }
    for (Vec3& normal : normals)
        normal = normal.normalized(); // of zero it is zero
    return normals;
}

} // namespace toile::exports
