#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::exports {

/// File names of a sequence, one for each frame: skirt_####.obj names skirt_0000.obj, skirt_0001.obj, ...
/// Each # is a digit; larger numbers have more digits.
class NumberedFiles {
public:
    /// @param pattern  a path with one run of # in its file name; otherwise "_####" is inserted before the
    ///                 extension
    explicit NumberedFiles(const std::filesystem::path& pattern);

    std::filesystem::path file(int number) const;
    /// Path with one # for each digit, which names this sequence and no file.
    std::filesystem::path pattern() const;
    /// File name without the digits and their separator: skirt for skirt_####.obj.
    std::string stem() const;
    /// Number in a file name of this sequence, or nothing for a foreign name.
    std::optional<int> number_of(const std::string& file_name) const;
    /// Numbers of the files that exist, ascending.
    std::vector<int> existing() const;

    /// Folder of the files until the sequence is complete: skirt.partial.
    std::filesystem::path unfinished_folder() const;
    /// The same names in that folder.
    NumberedFiles unfinished() const;

    static bool has_digits_placeholder(const std::filesystem::path& pattern);

private:
    std::filesystem::path folder_;
    std::string prefix_;
    std::string suffix_;
    int digits_ = 4;
};

/// Files of the frames that a .pvd lists: skirt_####.vtu for skirt.pvd.
NumberedFiles frames_of_pvd(std::filesystem::path pvd);

/// Files of the frames of a cache that has one for each: an OBJ or PLY sequence, or a .pvd.
/// @return nothing for a single file
std::optional<NumberedFiles> files_of_frames(const std::filesystem::path& cache, int frame_count);

} // namespace toile::exports
