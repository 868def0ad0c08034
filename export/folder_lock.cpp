#include "export/folder_lock.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/base/error.h"
#include "export/binary_file.h"

namespace toile::exports {

namespace {

/// "process 4711 on host loom since 2026-05-04 10:20:30", the content of a lock's file.
std::string own_name()
{
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    ::localtime_r(&now, &local);
    std::array<char, 32> time{};
    std::strftime(time.data(), time.size(), "%Y-%m-%d %H:%M:%S", &local);
    return "process " + std::to_string(::getpid()) + " on host " + host.data() + " since " + time.data();
}

/// The folder from the root, without a dot at its end.
std::filesystem::path from_root(const std::filesystem::path& folder)
{
    return std::filesystem::absolute(folder / ".").parent_path();
}

/// Takes an exclusive lock. Probes of other runs (require_free) hold it for a moment, which is waited for.
/// @return 0 or errno
int lock(int descriptor)
{
    constexpr int kTries = 20;
    for (int tried = 0; ::flock(descriptor, LOCK_EX | LOCK_NB) != 0; ++tried) {
        if (errno != EWOULDBLOCK || tried == kTries)
            return errno;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return 0;
}

bool means_no_locks(int error)
{
    return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

[[noreturn]] void refuse(const std::filesystem::path& folder, int descriptor)
{
    std::array<char, 512> holder{};
    const bool is_known = ::pread(descriptor, holder.data(), holder.size() - 1, 0) > 0;
    ::close(descriptor);
    throw InvalidInput(folder.string() + ": another run is writing there" +
                       (is_known ? ", " + std::string(holder.data()) : "") +
                       "; wait for it or choose another folder");
}

/// @return outermost missing folder; empty if all exist
std::filesystem::path create_folders(const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::path first_missing;
    for (std::filesystem::path at = from_root(folder);
         !std::filesystem::exists(at, error) && at.has_relative_path(); at = at.parent_path())
        first_missing = at;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InvalidInput(folder.string() + ": this folder can't be created (" + error.message() +
                           "); choose a writable folder");
    return first_missing;
}

int open_lock(const std::filesystem::path& folder, int flags)
{
    return ::open(FolderLock::file_in(folder).c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0666);
}

} // namespace

std::filesystem::path FolderLock::file_in(const std::filesystem::path& folder)
{
    return folder / ".toile.lock";
}

void FolderLock::require_free(const std::filesystem::path& folder)
{
    const int descriptor = open_lock(folder, O_RDONLY);
    if (descriptor < 0)
        return;
    if (::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        refuse(folder, descriptor);
    ::close(descriptor);
}

FolderLock::FolderLock(const std::filesystem::path& folder,
                       const std::function<void(const std::string&)>& warn)
    : folder_(folder.empty() ? "." : folder), from_root_(from_root(folder_)),
      first_created_(create_folders(folder_))
{
    while (true) {
        descriptor_ = open_lock(folder_, O_RDWR | O_CREAT);
        const bool is_foreign = descriptor_ < 0 && errno == EACCES; // the file of another user
        if (is_foreign)
            descriptor_ = open_lock(folder_, O_RDONLY);
        if (descriptor_ < 0) {
            const std::string reason = std::strerror(errno);
            remove_created_folders();
            throw InvalidInput(folder_.string() + ": can't be written (" + reason +
                               "); choose a writable folder");
        }
        if (const int error = lock(descriptor_); error == EWOULDBLOCK) {
            refuse(folder_, descriptor_);
        } else if (error != 0) {
            if (!means_no_locks(error)) {
                ::close(descriptor_);
                remove_created_folders();
                throw InvalidInput(folder_.string() + ": can't be locked (" + std::strerror(error) +
                                   "); choose another folder");
            }
            if (warn)
                warn(folder_.string() + ": this file system has no locks (" + std::strerror(error) +
                     "); a second run into this folder would not be noticed");
            break;
        }
        // The holder may have removed the file between open() and flock(): then this lock keeps nobody out.
        const bool is_held = leads_to(file_in(folder_), descriptor_);
        if (is_held && (!is_foreign || ::unlink(file_in(folder_).c_str()) != 0))
            break;
        ::close(descriptor_);
    }
    const std::string name = own_name();
    if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, name.data(), name.size(), 0) < 0)
        return; // a full disk: the lock holds without a name
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : folder_(std::move(other.folder_)), from_root_(std::move(other.from_root_)),
      first_created_(std::move(other.first_created_)), descriptor_(std::exchange(other.descriptor_, -1))
{
}

FolderLock::~FolderLock()
{
    if (descriptor_ < 0)
        return;
    if (leads_to(file_in(folder_), descriptor_))
        ::unlink(file_in(folder_).c_str());
    ::close(descriptor_);
    remove_created_folders();
}

void FolderLock::remove_created_folders()
{
    if (first_created_.empty())
        return;
    std::filesystem::path at = from_root_;
    while (::rmdir(at.c_str()) == 0 && at != first_created_)
        at = at.parent_path();
}

} // namespace toile::exports
