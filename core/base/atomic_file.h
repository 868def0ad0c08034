#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace toile {

/// Creates the folders above a file that is about to be written.
/// @throws InvalidInput if they can't be created
void create_parent_folder(const std::filesystem::path& file);

/// Name of a file that is not finished yet: skirt.partial.obj for skirt.obj, run.partial for run.
std::filesystem::path partial_beside(const std::filesystem::path& file);

/// Name beside a file that no other thread or process of this machine gets.
std::filesystem::path unique_partial(const std::filesystem::path& file);

/// Refuses, before long work, a file that could not be written after it: by creating and removing a file in
/// its folder, or in the innermost existing folder above.
/// @throws InvalidInput naming the reason: a folder has the name, or no folder can be written to.
void require_writable(const std::filesystem::path& file);

/// The same for a folder, which need not exist yet.
void require_writable_folder(const std::filesystem::path& folder);

/// Whether writing to the path must not replace it: a device, a pipe, a socket, or a name in /dev or /proc
/// such as /dev/stdout, which may stand for a file.
bool is_stream(const std::filesystem::path& path);

/// Content that waits beside its file under another name. Readers see the old content or the new, never half
/// of it. A symbolic link is replaced, not what it points to. A stream receives the content by commit().
class StagedFile {
public:
    /// Creates missing folders and writes the partial.
    /// @throws InvalidInput if it can't be created; DeviceError if the write breaks off, with nothing left
    StagedFile(std::filesystem::path file, std::filesystem::path partial,
               std::span<const std::string_view> pieces);
    /// Removes the partial unless it was committed.
    ~StagedFile();
    StagedFile(StagedFile&& other) noexcept;
    StagedFile& operator=(StagedFile&& other) noexcept;
    StagedFile(const StagedFile&) = delete;
    StagedFile& operator=(const StagedFile&) = delete;

    /// Renames the partial to its file.
    /// @throws InvalidInput if the system refuses, for instance because a folder has the name
    void commit();

private:
    std::filesystem::path file_;
    std::filesystem::path partial_; ///< empty: committed, or a stream
    std::string content_;           ///< of a stream
};

/// Stages and commits a file at once. Several threads and processes may write the same file: the last one
/// stays.
/// @param pieces  written one after the other
/// @throws as StagedFile. The old file stays, and no half-written one is left.
void write_atomically(const std::filesystem::path& file, std::span<const std::string_view> pieces);
inline void write_atomically(const std::filesystem::path& file, std::string_view content)
{
    write_atomically(file, std::span(&content, 1));
}

/// True for names of unique_partial().
bool is_partial(const std::filesystem::path& file);

} // namespace toile
