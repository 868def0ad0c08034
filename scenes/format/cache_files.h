#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Files of a scene that are caches, told by their names.
namespace toile::scene_format {

class Document;

/// True for a cache of positions or a mesh in an archive: shot.abc#/body/bodyShape, body.pc2, body_####.obj.
/// A single OBJ is a mesh.
bool is_cache(const std::filesystem::path& file);

/// True if the format of a cache stores the times of its samples.
bool has_times(const std::filesystem::path& cache);

/// Files that a cache or another file consists of: the archive, all of a sequence, or itself.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file);

/// Path of a cache or another file at `key_path`, as Document::existing_file() makes it: with the mesh behind
/// its #, or with the digits of a sequence.
/// @throws InvalidInput if the file, or the first one of a sequence, is missing
std::filesystem::path existing_cache(const Document& document, const std::filesystem::path& file,
                                     const std::string& key_path);

} // namespace toile::scene_format
