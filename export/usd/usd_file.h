#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "export/binary_file.h"

namespace toile::exports {

/// Text in quotes, as .usda stores it. Bytes that are not UTF-8 become _.
std::string usd_quoted(const std::string& text);

/// A .usda layer that is being written. It appears under its name when it is whole, or not at all.
class UsdFile {
public:
    /// @throws InvalidInput if it can't be created
    explicit UsdFile(std::filesystem::path file);
    /// Removes what was written, unless it was committed.
    ~UsdFile();
    UsdFile(const UsdFile&) = delete;
    UsdFile& operator=(const UsdFile&) = delete;

    UsdFile& operator<<(std::string_view text);

    /// Appends an array of tuples, in brackets: single numbers without parentheses for a width of 1. Floats
    /// read back with the same bits.
    /// @param numbers  [tuples x width]
    void append(const float* numbers, size_t count, int width);
    void append(const std::vector<int>& numbers);

    /// Lets the file appear; every byte of it is on the disk.
    void commit();

private:
    void flush_beyond(size_t size);

    std::filesystem::path path_, unfinished_;
    std::optional<BinaryFile> file_;
    std::int64_t size_ = 0; ///< written to file_
    std::string text_;      ///< after that
};

} // namespace toile::exports
