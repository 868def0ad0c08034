#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "export/cache_writer.h"
#include "export/point_cache.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace exports;

using ExportTest = FileTest;

/// Two quads and a triangle over seven vertices, with texture coordinates.
inline ObjMesh quad_mesh()
{
    ObjMesh mesh;
    for (int v = 0; v < 7; ++v) {
        const int column = v % 3, row = v / 3;
        mesh.positions.push_back(Vec3(column, row, 0.25 * v));
    }
    mesh.texture_coordinates = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0.5, 0.5)};
    mesh.polygons = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 6}};
    mesh.polygon_uvs = {{0, 1, 2, 3}, {3, 2, 1, 0}, {0, 4, 2}};
    return mesh;
}

/// Positions exact in single precision and distinct for every frame, vertex and axis.
inline std::vector<Vec3> frame_positions(int frame, int vertex_count)
{
    std::vector<Vec3> positions;
    positions.reserve(vertex_count);
    for (int v = 0; v < vertex_count; ++v)
        positions.push_back(Vec3(frame + 0.5, v + 0.25, -(100.0 * frame + v)));
    return positions;
}

inline void write_frames(CacheWriter& writer, int first, int end, int vertex_count)
{
    for (int frame = first; frame < end; ++frame)
        writer.write(frame, frame_positions(frame, vertex_count));
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

} // namespace toile::test
