#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::exports {

enum class CacheFormat { Pc2, Mdd, Abc, Obj };

/// Extensions of all formats that are written: .pc2, .mdd, .obj, .abc.
const std::vector<std::string>& cache_extensions();

/// Format for the extension of `file`: .pc2, .mdd, .abc or .obj. A mesh in an archive
/// may follow: run.abc#/skirt/skirtShape.
/// @throws InvalidInput for any other.
CacheFormat cache_format(const std::filesystem::path& file);

/// Whether caches of a format hold the faces that they play on.
bool stores_faces(CacheFormat format);

/// Whether they hold any number of meshes.
bool holds_several_meshes(CacheFormat format);

/// Whether they hold normals.
bool stores_normals(CacheFormat format);

/// Whether their frames are numbered as a scene's time line, which begins at 1 in most programs.
bool has_time_line(CacheFormat format);

/// Whether they are a file for each frame.
bool is_numbered(CacheFormat format);

} // namespace toile::exports
