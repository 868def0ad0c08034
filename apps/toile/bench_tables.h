#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile {

/// A file of a benchmark's results, by its name inside the output folder.
struct TableFile {
    std::string name;
    std::string content;
};

/// Refuses a folder before a run that could not be written after it, and creates it.
/// @throws InvalidInput  naming the folder or file
void require_place(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes each file whole or not at all and lists it on standard output; nothing for an empty folder.
void write_tables(const std::filesystem::path& folder, const std::vector<TableFile>& files);

} // namespace toile
