#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace toile::test {

inline std::string bytes_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Empty folder, removed at the end of its test.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "toile-test-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& content) const
    {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }

    /// Name and content of every file below; empty for what is no regular file.
    std::map<std::string, std::string> snapshot() const
    {
        std::map<std::string, std::string> files;
        std::error_code unreadable; // links that lead nowhere
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path_))
            files[entry.path().string()] = entry.is_regular_file(unreadable) ? bytes_of(entry.path()) : "";
        return files;
    }

private:
    std::filesystem::path path_;
};

/// Folder of this process, removed at its end: tests that write files of one name may run side by side.
inline const std::filesystem::path& process_folder()
{
    static const TemporaryFolder folder;
    return folder.path();
}

/// Fixture with a private folder.
class FileTest : public ::testing::Test {
protected:
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

    const TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
};

} // namespace toile::test
