#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace toile::volume {

/// A file in the legacy VTK format: words, and arrays in ASCII or as big-endian numbers.
/// Every refusal is an InvalidInput naming the file and the line, or the byte behind binary numbers.
class VtkFile {
public:
    /// Reads the header: version, title, ASCII or BINARY.
    /// @throws InvalidInput for a file that can't be read or has another header
    explicit VtkFile(const std::filesystem::path& file);

    /// Data set: "unstructured_grid".
    std::string dataset();

    /// Reads the name of the next section, in lower case; skips metadata and fields, which no section needs.
    std::string section();

    /// Next word in lower case; empty at the end of the file.
    std::string word();
    void expect(const std::string& keyword);
    std::int64_t count();

    /// Reads `count` numbers of a type: "float", "vtktypeint64". In binary files they begin after the line.
    std::vector<double> numbers(std::int64_t count, const std::string& type);
    std::vector<std::int64_t> whole_numbers(std::int64_t count, const std::string& type);

    /// True if the next word is `keyword`, which stays next.
    bool is_next(const std::string& keyword);

    [[noreturn]] void refuse(const std::string& why) const;

private:
    std::string_view take_line();
    std::string_view take_word();
    void skip_metadata();
    void skip_field();
    template <typename Number>
    std::vector<Number> values(std::int64_t count, const std::string& type);
    template <typename Number, typename Stored>
    std::vector<Number> binary_values(std::int64_t count);

    std::filesystem::path file_;
    std::string text_;
    size_t at_ = 0;
    bool is_binary_ = false;
    bool has_read_binary_ = false; ///< lines can't be counted any more
};

} // namespace toile::volume
