#include "scenes/surfaces/cloth_state.h"

#include <algorithm>

#include "core/base/error.h"

namespace toile::scenes {

std::vector<Vec3> ClothState::to_file(View<const Vec3> x) const
{
    if (!has_file_order())
        return {x.begin(), x.end()};
    std::vector<Vec3> out;
    out.reserve(numbers.vertex.size());
    for (size_t v = 0; v < numbers.vertex.size(); ++v) {
        const int own = numbers.vertex[v];
        out.push_back(x[own] + (file.positions[v] - rest.positions[own]));
    }
    return out;
}

std::vector<Vec3> ClothState::from_file(View<const Vec3> x) const
{
    if (!has_file_order())
        return {x.begin(), x.end()};
    std::vector<Vec3> out;
    out.reserve(rest.positions.size());
    for (const int v : numbers.file_vertex)
        out.push_back(x[v]);
    return out;
}

int ClothState::vertex_of_file(int file_vertex, const std::string& location, const std::string& remedy) const
{
    const int count = int(numbers.vertex.empty() ? rest.positions.size() : numbers.vertex.size());
    if (file_vertex < 0 || file_vertex >= count)
        throw InvalidInput(location + ": vertex " + std::to_string(file_vertex) + " is out of range; \"" +
                           name + "\" has vertices 0 to " + std::to_string(count - 1));
    if (std::binary_search(numbers.loose.begin(), numbers.loose.end(), file_vertex))
        throw InvalidInput(location + ": vertex " + std::to_string(file_vertex) + " of \"" + name +
                           "\" has no face; " + remedy);
    return numbers.vertex.empty() ? file_vertex : numbers.vertex[size_t(file_vertex)];
}

int ClothState::file_vertex(int vertex) const
{
    return vertex < int(numbers.file_vertex.size()) ? numbers.file_vertex[size_t(vertex)] : vertex;
}

std::vector<garment::Fabric> ClothState::fabrics() const
{
    std::vector<garment::Fabric> fabrics{fabric};
    fabrics.insert(fabrics.end(), group_fabrics.begin(), group_fabrics.end());
    return fabrics;
}

std::vector<std::vector<int>> ClothState::triangles_by_fabric() const
{
    std::vector<std::vector<int>> of_fabric(1 + group_fabrics.size());
    for (int t = 0; t < int(triangles.size()); ++t)
        of_fabric[fabric_of_triangle.empty() ? 0 : size_t(fabric_of_triangle[size_t(t)])].push_back(t);
    return of_fabric;
}

std::vector<unsigned char> ClothState::attached(double t) const
{
    std::vector<unsigned char> attached(rest.positions.size(), 0);
    for (const Attachment& attachment : attachments)
        if (t < attachment.release)
            for (const int v : attachment.vertices)
                attached[v] = 1;
    return attached;
}

} // namespace toile::scenes
