#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace toile::exports {

/// A file of bytes read and written by offset. Written bytes are with the operating system when the call
/// returns, so they outlive a killed process; sync() makes them outlive a power failure too.
class BinaryFile {
public:
    enum class Mode {
        Read,     ///< must exist
        Create,   ///< emptied if it exists; missing parent folders are created
        Continue, ///< must exist; content kept
    };

    /// @throws InvalidInput if the file can't be opened.
    BinaryFile(const std::filesystem::path& file, Mode mode);
    ~BinaryFile();
    BinaryFile(const BinaryFile&) = delete;
    BinaryFile& operator=(const BinaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::int64_t size() const;

    /// Reads or writes all bytes, or throws DeviceError.
    void read_at(std::int64_t offset, char* bytes, std::size_t count) const;
    void write_at(std::int64_t offset, std::string_view bytes);

    void resize(std::int64_t size);
    void sync();

    /// @throws DeviceError if the path does not lead to this file any more
    void require_in_place() const;

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
};

/// Whether a path leads to an open file.
bool leads_to(const std::filesystem::path& path, int descriptor);

/// Renames a completed file to its final name, replacing an existing file.
/// @throws DeviceError naming both if the system refuses.
void move_into_place(const std::filesystem::path& complete, const std::filesystem::path& file);

} // namespace toile::exports
