#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace toile {

/// Creates the folders above a file that is about to be written.
/// @throws InvalidInput if they can't be created
void create_parent_folder(const std::filesystem::path& file);

/// Writes a temporary file beside `file` and renames it: readers see the old content or the new, never half
/// of it. Creates missing parent folders. Several threads and processes may write the same file: the last one
/// stays.
/// @param pieces  written one after the other
/// @throws InvalidInput if the folder can't be created or written to, or the name is taken by a folder;
///         DeviceError if the write breaks off. The old file stays, and no half-written one is left.
void write_atomically(const std::filesystem::path& file, std::span<const std::string_view> pieces);
inline void write_atomically(const std::filesystem::path& file, std::string_view content)
{
    write_atomically(file, std::span(&content, 1));
}

/// True for temporary names that write_atomically() gives unfinished files.
bool is_partial(const std::filesystem::path& file);

} // namespace toile
