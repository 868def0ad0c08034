#include "core/backend/atomic_file.h"

#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include "core/backend/error.h"

namespace toile {

void create_parent_folder(const std::filesystem::path& file)
{
    std::error_code error;
    if (file.has_parent_path())
        std::filesystem::create_directories(file.parent_path(), error);
    if (error)
        throw InvalidInput(file.string() + ": its folder can't be created (" + error.message() +
                           "); choose a writable folder");
}

void write_atomically(const std::filesystem::path& file, std::string_view content)
{
    create_parent_folder(file);
    std::error_code error;
    const std::filesystem::path partial = file.string() + ".partial-" + std::to_string(::getpid());
    std::ofstream stream(partial, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be written; choose a writable folder");
    stream.write(content.data(), std::streamsize(content.size()));
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
