#pragma once

#include <filesystem>
#include <string>

#include "core/base/file_plan.h"

namespace toile::app {

/// Extensions of the caches that are read, for help: ".pc2, .mdd or .ply".
std::string readable_extensions();

/// Adds a file that is written under its partial name first.
void add_output_and_partial(FilePlan& plan, const std::filesystem::path& file, const std::string& role);

/// Adds every file of a cache that is written: finished, unfinished, and frames of an earlier sequence, which
/// are removed.
/// @param first  number of the first frame in a sequence
void add_cache_output(FilePlan& plan, const std::filesystem::path& file, int first, int frame_count,
                      const std::string& role);

/// Adds every file of a cache that is read, which may be a mesh in an archive.
void add_cache_input(FilePlan& plan, const std::filesystem::path& file, const std::string& role);

/// Refuses a name that can't be replaced by a file, or should not be.
/// @throws InvalidInput
void require_replaceable(const std::filesystem::path& file);

/// The same for every file of a cache.
void require_writable_cache(const std::filesystem::path& file, int first, int frame_count);

} // namespace toile::app
