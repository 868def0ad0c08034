#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/backend/error.h"
#include "export/cache_writer.h"
#include "export/point_cache.h"

namespace toile {

/// A fresh folder per test, removed afterwards.
class ExportTest : public testing::Test {
protected:
    void SetUp() override
    {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("toile_export_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

    std::filesystem::path folder_;
};

/// Two quads and a triangle over seven vertices, with texture coordinates.
inline ObjMesh quad_mesh()
{
    ObjMesh mesh;
    for (int v = 0; v < 7; ++v)
        mesh.positions.push_back(Vec3(v % 3, v / 3, 0.25 * v));
    mesh.texture_coordinates = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0.5, 0.5)};
    mesh.polygons = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 6}};
    mesh.polygon_uvs = {{0, 1, 2, 3}, {3, 2, 1, 0}, {0, 4, 2}};
    return mesh;
}

/// Positions that floats hold exactly and that tell frame, vertex and axis apart.
inline std::vector<Vec3> frame_positions(int frame, int vertex_count)
{
    std::vector<Vec3> positions;
    for (int v = 0; v < vertex_count; ++v)
        positions.push_back(Vec3(frame + 0.5, v + 0.25, -(100.0 * frame + v)));
    return positions;
}

inline void write_frames(CacheWriter& writer, int first, int end, int vertex_count)
{
    for (int frame = first; frame < end; ++frame)
        writer.write(frame, frame_positions(frame, vertex_count));
}

inline std::string bytes_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// The message of the InvalidInput that `act` throws; empty when it throws none.
template <typename Act>
std::string refusal(const Act& act)
{
    try {
        act();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

} // namespace toile
