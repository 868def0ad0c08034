#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile::research {

/// A results file of a benchmark; the name is relative to the output folder.
struct TableFile {
    std::string name;
    std::string content;
};

/// Creates the folder, or rejects it before the run if its files could not be written afterwards.
/// @throws InvalidInput  naming the folder or file
void require_writable(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes each file atomically and lists it on standard output; nothing for an empty folder.
void write_tables(const std::filesystem::path& folder, const std::vector<TableFile>& files);

/// Likewise, but lists nothing: for results so far.
void update_tables(const std::filesystem::path& folder, const std::vector<TableFile>& files);

} // namespace toile::research
