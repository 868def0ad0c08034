#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/base/atomic_file.h"
#include "export/byte_order.h"
#include "export/ply/ply_file.h"
#include "export/ply/ply_header.h"

namespace toile::exports {

namespace {

/// Appends the number of values of a list: one byte where every list of the file has few.
void append_count(std::string& bytes, size_t count, bool is_short)
{
    if (is_short)
        append(bytes, std::uint8_t(count));
    else
        append(bytes, std::uint32_t(count));
}

/// Everything in front of the vertices, and behind them: the same in all frames.
struct PlyFrame {
    std::string header, faces;
};

PlyFrame frame_of(const CacheLayout& layout)
{
    const ObjMesh& mesh = layout.meshes.front().faces;
    const bool has_texture = !mesh.polygon_uvs.empty();
    size_t most = 0; // corners of a polygon
    for (const std::vector<int>& polygon : mesh.polygons)
        most = std::max(most, polygon.size());
    const bool is_short = (has_texture ? 2 : 1) * most <= 255;

    PlyFrame frame;
    const std::string count_type = is_short ? "uchar" : "uint";
    frame.header = "ply\nformat binary_little_endian 1.0\n" + axes_comment(layout.axes) +
                   "\nelement vertex " + std::to_string(layout.vertex_count()) +
                   "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                   std::to_string(mesh.polygons.size()) + "\nproperty list " + count_type +
                   " int vertex_indices\n" +
                   (has_texture ? "property list " + count_type + " float texcoord\n" : "") + "end_header\n";
    for (size_t p = 0; p < mesh.polygons.size(); ++p) {
        append_count(frame.faces, mesh.polygons[p].size(), is_short);
        for (const int v : mesh.polygons[p])
            append(frame.faces, std::int32_t(v));
        if (!has_texture)
            continue;
        append_count(frame.faces, 2 * mesh.polygon_uvs[p].size(), is_short);
        for (const int uv : mesh.polygon_uvs[p])
            for (const double coordinate : mesh.texture_coordinates[size_t(uv)])
                append(frame.faces, float(coordinate));
    }
    return frame;
}

} // namespace

MeshFileWriter ply_file_writer(const CacheLayout& layout)
{
    return [frame = frame_of(layout)](const std::filesystem::path& file, View<const Vec3> positions) {
        std::string vertices;
        vertices.reserve(12 * size_t(positions.size()));
        for (const Vec3& x : positions)
            for (const double coordinate : x)
                append(vertices, float(coordinate));
        write_atomically(file, std::array<std::string_view, 3>{frame.header, vertices, frame.faces});
    };
}

} // namespace toile::exports
