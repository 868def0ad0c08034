#include "core/base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace toile {

namespace {

constexpr const char* kPartial = ".partial-";

const char* remedy_of(int error)
{
    switch (error) {
    case EMFILE:
    case ENFILE:
        return "raise the limit of open files (ulimit -n)";
    case ENAMETOOLONG:
        return "choose a shorter name";
    case ENOSPC:
    case EDQUOT:
        return "make room on the disk";
    default:
        return "choose a writable folder";
    }
}

[[noreturn]] void refuse_to_write(const std::filesystem::path& file, int error)
{
    throw InvalidInput(file.string() + ": can't be written (" + std::strerror(error) + "); " +
                       remedy_of(error));
}

/// Writes everything and closes. @return 0 or errno
int write_and_close(int descriptor, std::span<const std::string_view> pieces)
{
    int error = 0;
    for (std::string_view rest : pieces)
        while (!rest.empty() && error == 0) {
            const ssize_t done = ::write(descriptor, rest.data(), rest.size());
            if (done >= 0)
                rest.remove_prefix(std::size_t(done));
            else if (errno != EINTR)
                error = errno;
        }
    if (::close(descriptor) != 0 && error == 0)
        error = errno;
    return error;
}

[[noreturn]] void broke_off(const std::filesystem::path& file, int error)
{
    throw DeviceError(file.string() + ": writing broke off (" + std::strerror(error) + ")");
}

/// Opens a stream for writing: that of this process if it is one, whose position then advances; else anew. A
/// pipe without a reader is refused, because opening it would wait for one. @return -1 if that fails
int open_stream(const std::filesystem::path& stream)
{
    struct stat named {
    }, own{};
    ::stat(stream.c_str(), &named);
    for (const int standard : {STDOUT_FILENO, STDERR_FILENO})
        if (::fstat(standard, &own) == 0 && own.st_dev == named.st_dev && own.st_ino == named.st_ino)
            return ::fcntl(standard, F_DUPFD_CLOEXEC, 0);
    const int descriptor = ::open(stream.c_str(), O_WRONLY | O_APPEND | O_NONBLOCK | O_CLOEXEC);
    if (descriptor >= 0)
        ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
    return descriptor;
}

void write_to_stream(const std::filesystem::path& stream, std::string_view content)
{
    const int descriptor = open_stream(stream);
    if (descriptor < 0)
        throw DeviceError(stream.string() + ": can't be written (" +
                          (errno == ENXIO ? "no program reads this pipe" : std::strerror(errno)) + ")");
    if (const int error = write_and_close(descriptor, std::span(&content, 1)); error != 0)
        broke_off(stream, error);
}

/// Whether the file is one of another user that only its owner may replace: in a sticky folder such as /tmp.
bool is_kept_by_its_owner(const std::filesystem::path& file)
{
    struct stat own {
    }, folder{};
    const uid_t user = ::geteuid();
    return user != 0 && ::lstat(file.c_str(), &own) == 0 &&
           ::stat((file.parent_path() / ".").c_str(), &folder) == 0 && (folder.st_mode & S_ISVTX) != 0 &&
           own.st_uid != user && folder.st_uid != user;
}

/// Creates and removes a file. @param named  what to name where that fails
void probe(const std::filesystem::path& folder, const std::filesystem::path& name,
           const std::filesystem::path& named)
{
    std::error_code missing;
    if (!std::filesystem::is_directory(folder, missing))
        throw InvalidInput(named.string() + ": " + folder.string() +
                           " is no folder; choose a writable folder");
    const std::filesystem::path file = folder / unique_partial(name);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0)
        refuse_to_write(named, errno);
    ::close(descriptor);
    ::unlink(file.c_str());
}

/// The folder, or the innermost above it that exists.
std::filesystem::path existing_above(std::filesystem::path folder)
{
    std::error_code unreachable; // counts as missing
    while (folder.has_relative_path() && !std::filesystem::exists(folder, unreachable))
        folder = folder.parent_path();
    return folder;
}

} // namespace

void create_parent_folder(const std::filesystem::path& file)
{
    std::error_code error;
    if (file.has_parent_path())
        std::filesystem::create_directories(file.parent_path(), error);
    if (error)
        throw InvalidInput(file.string() + ": its folder can't be created (" + error.message() +
                           "); choose a writable folder");
}

std::filesystem::path partial_beside(const std::filesystem::path& file)
{
    return file.parent_path() / (file.stem().string() + ".partial" + file.extension().string());
}

std::filesystem::path unique_partial(const std::filesystem::path& file)
{
    static std::atomic<long> count = 0;
    return file.string() + kPartial + std::to_string(::getpid()) + "-" + std::to_string(++count);
}

bool is_partial(const std::filesystem::path& file)
{
    return file.filename().string().find(kPartial) != std::string::npos;
}

bool is_stream(const std::filesystem::path& path)
{
    std::error_code missing;
    const std::filesystem::file_status status = std::filesystem::status(path, missing);
    if (!std::filesystem::exists(status) || std::filesystem::is_directory(status))
        return false;
    if (!std::filesystem::is_regular_file(status))
        return true;
    const std::filesystem::path folder = std::filesystem::canonical(path.parent_path() / ".", missing);
    return std::filesystem::is_symlink(path, missing) &&
           (folder == "/dev" || folder == "/dev/fd" || folder.string().starts_with("/proc/"));
}

void require_writable(const std::filesystem::path& file)
{
    std::error_code error;
    if (std::filesystem::is_directory(file, error) || !file.has_filename())
        throw InvalidInput(file.string() + ": is a folder; name a file");
    if (is_stream(file)) {
        if (::access(file.c_str(), W_OK) != 0)
            refuse_to_write(file, errno);
        return;
    }
    if (is_kept_by_its_owner(file))
        throw InvalidInput(file.string() +
                           ": is of another user, who alone can replace it; choose another folder");
    probe(existing_above(std::filesystem::absolute(file).parent_path()), file.filename(), file);
}

void require_writable_folder(const std::filesystem::path& folder)
{
    probe(existing_above(std::filesystem::absolute(folder / ".").parent_path()), "probe", folder);
}

StagedFile::StagedFile(std::filesystem::path file, std::filesystem::path partial,
                       std::span<const std::string_view> pieces)
    : file_(std::move(file))
{
    if (is_stream(file_)) {
        for (const std::string_view piece : pieces)
            content_ += piece;
        return;
    }
    create_parent_folder(file_);
    const int descriptor = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0)
        refuse_to_write(file_, errno);
    partial_ = std::move(partial);
    if (const int error = write_and_close(descriptor, pieces); error != 0) {
        ::unlink(partial_.c_str());
        broke_off(file_, error);
    }
}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : file_(std::move(other.file_)), partial_(std::exchange(other.partial_, {})),
      content_(std::move(other.content_))
{
}

StagedFile& StagedFile::operator=(StagedFile&& other) noexcept
{
    std::swap(file_, other.file_);
    std::swap(partial_, other.partial_);
    std::swap(content_, other.content_);
    return *this;
}

StagedFile::~StagedFile()
{
    if (!partial_.empty())
        ::unlink(partial_.c_str());
}

void StagedFile::commit()
{
    if (partial_.empty()) {
        write_to_stream(file_, content_);
        return;
    }
    std::error_code error;
    std::filesystem::rename(partial_, file_, error);
    if (error)
        throw InvalidInput(file_.string() + ": can't be replaced (" + error.message() +
                           "); choose another name");
    partial_.clear();
}

void write_atomically(const std::filesystem::path& file, std::span<const std::string_view> pieces)
{
    StagedFile(file, unique_partial(file), pieces).commit();
}

} // namespace toile
