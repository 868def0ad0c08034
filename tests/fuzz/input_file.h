#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace toile::test {

/// Input of a fuzzer as a file, for readers that open one. One per process and extension; overwritten.
class InputFile {
public:
    explicit InputFile(const std::string& extension)
        : path_(std::filesystem::temp_directory_path() /
                ("toile-fuzz-" + std::to_string(::getpid()) + extension))
    {
    }
    ~InputFile() { std::filesystem::remove(path_); }
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    const std::filesystem::path& write(const std::uint8_t* data, std::size_t size) const
    {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(data), std::streamsize(size));
        return path_;
    }

private:
    std::filesystem::path path_;
};

} // namespace toile::test
