#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "export/binary_file.h"

namespace toile::exports {

/// A list of files with their times (.pvd), as ParaView reads it. It is readable at any moment: an entry and
/// the end of the list are written at once over the old end.
class PvdFile {
public:
    /// The file appears with its first entry; until then one of an earlier run stays.
    explicit PvdFile(std::filesystem::path file) : path_(std::move(file)) {}

    const std::filesystem::path& path() const { return path_; }

    /// @param time  [s]
    /// @param name  of a file in the same folder
    /// @throws DeviceError if the disk refuses or the file was removed
    void add(double time, const std::string& name);

    /// Every byte is then on the disk.
    void complete();

private:
    std::filesystem::path path_;
    std::optional<BinaryFile> file_; ///< empty before the first entry
    std::int64_t end_ = 0;           ///< of the entries [bytes]
};

} // namespace toile::exports
