#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace toile::exports {

/// Keeps other runs from writing into a folder. It holds an exclusive lock (flock) on the file .toile.lock
/// there, which tells host, process and time. The system releases the lock of a process that has died, so its
/// file is taken over by the next run.
class FolderLock {
public:
    /// Creates the folder if it is missing.
    /// @param warn  told that the file system has no locks, so that other runs are not kept out; may be empty
    /// @throws InvalidInput if another run holds the lock, naming it, or the folder can't be written to
    explicit FolderLock(const std::filesystem::path& folder,
                        const std::function<void(const std::string&)>& warn = {});
    /// Removes the file, and folders that the constructor created if they are empty.
    ~FolderLock();
    FolderLock(FolderLock&& other) noexcept;
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Refuses a folder that is locked now, as the constructor does, but changes no file.
    static void require_free(const std::filesystem::path& folder);

    static std::filesystem::path file_in(const std::filesystem::path& folder);

private:
    void remove_created_folders();

    std::filesystem::path folder_;
    std::filesystem::path from_root_;     ///< the same, which stays valid where the working folder is removed
    std::filesystem::path first_created_; ///< outermost folder that was missing; empty: none was
    int descriptor_ = -1;
};

} // namespace toile::exports
