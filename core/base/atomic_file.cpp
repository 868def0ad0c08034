#include "core/base/atomic_file.h"

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include "core/base/error.h"

namespace toile {

namespace {

constexpr const char* kPartial = ".partial-";

/// Name that differs between the threads and processes of a machine.
std::filesystem::path partial_name(const std::filesystem::path& file)
{
    static std::atomic<long> count = 0;
    return file.string() + kPartial + std::to_string(::getpid()) + "-" + std::to_string(++count);
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

bool is_partial(const std::filesystem::path& file)
{
    return file.filename().string().find(kPartial) != std::string::npos;
}

void write_atomically(const std::filesystem::path& file, std::span<const std::string_view> pieces)
{
    create_parent_folder(file);
    std::error_code error;
    const std::filesystem::path partial = partial_name(file);
    std::ofstream stream(partial, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be written; choose a writable folder");
    for (const std::string_view piece : pieces)
        stream.write(piece.data(), std::streamsize(piece.size()));
    stream.close();
    const bool written = stream.good();
    if (written)
        std::filesystem::rename(partial, file, error);
    if (written && !error)
        return;

    std::error_code ignored; // the first failure is the one to report
    std::filesystem::remove(partial, ignored);
    if (!written)
        throw DeviceError(file.string() + ": writing broke off; is the disk full?");
    throw InvalidInput(file.string() + ": can't be replaced (" + error.message() + "); choose another name");
}

} // namespace toile
