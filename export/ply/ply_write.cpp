#include <algorithm>
#include <array>
#include <cctype>
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

/// Appends the texture coordinates at the corners of a polygon.
void append_texture(std::string& bytes, const ObjMesh& mesh, size_t polygon, bool is_short)
{
    append_count(bytes, 2 * mesh.polygon_uvs[polygon].size(), is_short);
    for (const int uv : mesh.polygon_uvs[polygon])
        for (const double coordinate : mesh.texture_coordinates[size_t(uv)])
            append(bytes, float(coordinate));
}

/// A line for each panel: its number and its name.
std::string panel_comments(const std::vector<std::string>& names)
{
    std::string lines;
    for (size_t k = 0; k < names.size(); ++k) {
        lines += "comment panel " + std::to_string(k) + " ";
        for (const char c : names[k])
            lines += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? '_' : c;
        lines += "\n";
    }
    return lines;
}

/// Everything in front of the vertices, and behind them: the same in all frames.
struct PlyFrame {
    std::string header, faces;
};

PlyFrame frame_of(const CacheLayout& layout)
{
    const ObjMesh& mesh = layout.meshes.front().faces;
    const std::vector<int>& panels = layout.meshes.front().panels.of_face;
    const bool has_texture = !mesh.polygon_uvs.empty();
    size_t most = 0; // corners of a polygon
    for (const std::vector<int>& polygon : mesh.polygons)
        most = std::max(most, polygon.size());
    const bool is_short = (has_texture ? 2 : 1) * most <= 255;

    PlyFrame frame;
    const std::string count_type = is_short ? "uchar" : "uint";
    frame.header = "ply\nformat binary_little_endian 1.0\n" + axes_comment(layout.axes) + "\n" +
                   panel_comments(layout.meshes.front().panels.names) + "element vertex " +
                   std::to_string(layout.vertex_count()) +
                   "\nproperty float x\nproperty float y\nproperty float z\n";
    for (const std::string& attribute : layout.meshes.front().attributes)
        frame.header += "property float " + attribute + "\n";
    frame.header +=
        "element face " + std::to_string(mesh.polygons.size()) + "\nproperty list " + count_type +
        " int vertex_indices\n" + (has_texture ? "property list " + count_type + " float texcoord\n" : "") +
        (panels.empty() ? "" : "property int " + std::string(kPanelAttribute) + "\n") + "end_header\n";
    for (size_t p = 0; p < mesh.polygons.size(); ++p) {
        append_count(frame.faces, mesh.polygons[p].size(), is_short);
        for (const int v : mesh.polygons[p])
            append(frame.faces, std::int32_t(v));
        if (has_texture)
            append_texture(frame.faces, mesh, p, is_short);
        if (!panels.empty())
            append(frame.faces, std::int32_t(panels[p]));
    }
    return frame;
}

} // namespace

MeshFileWriter ply_file_writer(const CacheLayout& layout)
{
    return [frame = frame_of(layout)](const std::filesystem::path& file, const SampleView& sample) {
        const int count = sample.positions.size();
        std::string vertices;
        vertices.reserve(12 * size_t(count) + sizeof(float) * size_t(sample.attributes.size()));
        for (int v = 0; v < count; ++v) {
            for (const double coordinate : sample.positions[v])
                append(vertices, float(coordinate));
            for (int at = v; at < sample.attributes.size(); at += count)
                append(vertices, sample.attributes[at]);
        }
        write_atomically(file, std::array<std::string_view, 3>{frame.header, vertices, frame.faces});
    };
}

} // namespace toile::exports
