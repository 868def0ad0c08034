#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace toile {

/// The files that a program is about to read and write, so that none of its inputs becomes an output and no
/// output is written twice. Paths are one file if they resolve to one: by device and inode where it exists,
/// which sees through symbolic and hard links, else by folder and name.
class FilePlan {
public:
    /// @param role  for messages: "the scene", "the mesh of cloth \"skirt\""
    void add_input(const std::filesystem::path& file, const std::string& role);

    /// Streams (atomic_file.h) are no files and may be named twice.
    /// @throws InvalidInput naming both if the file is an input or output added before, or is a folder of one
    void add_output(const std::filesystem::path& file, const std::string& role);

private:
    struct Use {
        std::filesystem::path file;
        std::string role;
        bool is_input;
    };
    struct Identity {
        std::string by_name;  ///< canonical folder and name
        std::string by_inode; ///< empty: it does not exist
    };

    Identity identity_of(const std::filesystem::path& file);

    void add_folders_above(const std::string& name, const Use& use);
    [[noreturn]] static void refuse(const Use& use, const Use& earlier);

    std::map<std::string, Use> uses_;    ///< by either identity
    std::map<std::string, Use> folders_; ///< that outputs lie in, at any depth
    std::map<std::filesystem::path, std::filesystem::path> canonical_folders_;
};

} // namespace toile
