#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::exports {

enum class CacheFormat { Pc2, Mdd, Abc, Usd, Obj, Ply, Glb, Vtk };

/// Extensions of the caches that are written, and of those that are read.
const std::vector<std::string>& written_extensions();
const std::vector<std::string>& read_extensions();

/// Format for the extension of `file`; none for another. A mesh in an archive may follow:
/// run.abc#/skirt/skirtShape.
std::optional<CacheFormat> known_cache_format(const std::filesystem::path& file);

/// The same. @throws InvalidInput for another extension
CacheFormat cache_format(const std::filesystem::path& file);

/// The same of a cache that is to be read. @throws InvalidInput also for one that is for other programs only
CacheFormat format_to_read(const std::filesystem::path& file);

/// What caches of a format hold.
struct CacheFeatures {
    bool faces = false;   ///< that they play on
    bool several = false; ///< any number of meshes
    bool normals = false;
    bool attributes = false; ///< numbers at vertices and faces
    bool times = false;      ///< of their frames
    bool time_line = false;  ///< frames numbered as a scene's, which begins at 1 in most programs
    bool numbered = false;   ///< a file for each of several frames
    bool read_back = true;   ///< read_cache() reads them; others are for other programs only
};
CacheFeatures features_of(CacheFormat format);

} // namespace toile::exports
