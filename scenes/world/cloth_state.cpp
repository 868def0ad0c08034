#include "scenes/world/cloth_state.h"

#include <algorithm>

namespace toile::scenes {

std::vector<Vec3> ClothState::to_file(View<const Vec3> x) const
{
    if (!has_file_vertices())
        return {x.begin(), x.end()};
    std::vector<Vec3> out;
    out.reserve(file.vertex.size());
    for (size_t v = 0; v < file.vertex.size(); ++v) {
        const int own = file.vertex[v];
        out.push_back(x[own] + (file.mesh.positions[v] - rest.positions[own]));
    }
    return out;
}

std::vector<Vec3> ClothState::from_file(View<const Vec3> x) const
{
    if (!has_file_vertices())
        return {x.begin(), x.end()};
    std::vector<Vec3> out(rest.positions.size());
    for (int v = x.size() - 1; v >= 0; --v) // the first of several last
        if (file.mesh.positions[v] == rest.positions[file.vertex[v]])
            out[file.vertex[v]] = x[v];
    return out;
}

int ClothState::file_vertex(int vertex) const
{
    if (!has_file_vertices())
        return vertex;
    return int(std::find(file.vertex.begin(), file.vertex.end(), vertex) - file.vertex.begin());
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
