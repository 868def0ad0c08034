#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::test {

/// Two triangles facing +y over their shared edge (0, 1), as drawn at Edge in core/mesh/topology.h.
inline TriangleMesh two_triangles()
{
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, -1}, {0.5, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    return mesh;
}

/// Corner tetrahedron, facing outwards.
inline TriangleMesh tetrahedron()
{
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

/// Surface of TOILE_DATA_DIR by its path in that folder; empty if the file is missing.
inline std::optional<TriangleMesh> real_mesh(const std::string& name)
{
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / name;
    if (!std::filesystem::exists(file))
        return std::nullopt;
    return read_obj(file).triangulated();
}

/// Message of the InvalidInput that `action` throws; empty if it throws none.
template <typename Action>
std::string message_of(const Action& action)
{
    try {
        action();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return {};
}

} // namespace toile::test
