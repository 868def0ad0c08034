#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace toile {

/// Creates the folders above a file that is about to be written.
/// @throws InvalidInput when they can't be created.
void create_parent_folder(const std::filesystem::path& file);

/// Writes a whole file beside its name and renames it into place: readers see the old content or the new,
/// never half of it. Creates missing parent folders. Several threads and processes may write the same file:
/// the last one stays.
/// @param pieces  written one after the other
/// @throws InvalidInput when the folder can't be created or written to or the name is taken by a folder,
///         DeviceError when the write breaks off. The old file and no half-written one is left.
void write_atomically(const std::filesystem::path& file, std::span<const std::string_view> pieces);
inline void write_atomically(const std::filesystem::path& file, std::string_view content)
{
    write_atomically(file, std::span(&content, 1));
}

/// True for names that write_atomically() gives files it has not finished.
bool is_partial(const std::filesystem::path& file);

} // namespace toile
