#include "export/binary_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace toile::exports {

namespace {

[[noreturn]] void broke_off(const std::filesystem::path& file, const char* what)
{
    throw DeviceError(file.string() + ": " + what + " broke off (" + std::strerror(errno) + ")");
}

const char* remedy(BinaryFile::Mode mode)
{
    switch (mode) {
    case BinaryFile::Mode::Read:
        return "check the path and its permissions";
    case BinaryFile::Mode::Create:
        return "choose a writable folder";
    case BinaryFile::Mode::Continue:
        return "without it nothing can be resumed, start the run anew";
    }
    return "";
}

} // namespace

BinaryFile::BinaryFile(const std::filesystem::path& file, Mode mode) : path_(file)
{
    if (mode == Mode::Create)
        create_parent_folder(file);
    const int flags = mode == Mode::Read     ? O_RDONLY
                      : mode == Mode::Create ? O_RDWR | O_CREAT | O_TRUNC
                                             : O_RDWR;
    descriptor_ = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
        throw InvalidInput(file.string() + ": can't be opened (" + std::strerror(errno) + "); " +
                           remedy(mode));
}

BinaryFile::~BinaryFile() { ::close(descriptor_); }

std::int64_t BinaryFile::size() const
{
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0)
        broke_off(path_, "asking for the size");
    return status.st_size;
}

void BinaryFile::read_at(std::int64_t offset, char* bytes, std::size_t count) const
{
    while (count > 0) {
        const ssize_t done = ::pread(descriptor_, bytes, count, offset);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            broke_off(path_, "reading");
        bytes += done;
        offset += done;
        count -= std::size_t(done);
    }
}

void BinaryFile::write_at(std::int64_t offset, std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t done = ::pwrite(descriptor_, bytes.data(), bytes.size(), offset);
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            broke_off(path_, "writing");
        bytes.remove_prefix(std::size_t(done));
        offset += done;
    }
}

void BinaryFile::resize(std::int64_t size)
{
    if (::ftruncate(descriptor_, size) != 0)
        broke_off(path_, "resizing");
}

void BinaryFile::sync()
{
    if (::fsync(descriptor_) != 0)
        broke_off(path_, "writing");
}

void BinaryFile::require_in_place() const
{
    if (!leads_to(path_, descriptor_))
        throw DeviceError(path_.string() + ": was removed or replaced while it was being written");
}

bool leads_to(const std::filesystem::path& path, int descriptor)
{
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

void move_into_place(const std::filesystem::path& complete, const std::filesystem::path& file)
{
    std::error_code error;
    std::filesystem::rename(complete, file, error);
    if (error)
        throw DeviceError(complete.string() + ": can't be renamed to " + file.string() + " (" +
                          error.message() + ")" +
                          (std::filesystem::exists(complete) ? "; it is complete, rename it by hand" : ""));
}

} // namespace toile::exports
