#pragma once

#include <filesystem>

namespace toile::exports {

enum class CacheFormat { Pc2, Mdd, Abc, Obj, Ply, Glb, Vtk };

/// Format for the extension of `file`: .pc2, .mdd, .abc, .obj, .ply, .glb or .pvd. A mesh
/// in an archive may follow: run.abc#/skirt/skirtShape.
/// @throws InvalidInput for any other.
CacheFormat cache_format(const std::filesystem::path& file);

/// Whether caches of a format hold the faces that they play on.
bool stores_faces(CacheFormat format);

/// Whether they store the times of their frames.
bool stores_times(CacheFormat format);

/// Whether each of several frames is a file with a number.
bool numbers_frames(CacheFormat format);

/// Whether read_cache() reads them: .glb and .pvd are for other programs only.
bool is_read_back(CacheFormat format);

/// Whether they hold any number of meshes.
bool holds_several_meshes(CacheFormat format);

} // namespace toile::exports
