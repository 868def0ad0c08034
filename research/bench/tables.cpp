#include "research/bench/tables.h"

#include <iostream>

#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace toile::research {

void require_writable(const std::filesystem::path& folder, const std::vector<std::string>& names)
{
    for (const std::string& name : names) {
        create_parent_folder(folder / name);
        if (std::filesystem::is_directory(folder / name))
            throw InvalidInput((folder / name).string() + ": is a folder; choose another path with -o");
    }
    if (::access(folder.c_str(), W_OK) != 0)
        throw InvalidInput(folder.string() + ": can't be written to; choose another path with -o");
}

void write_tables(const std::filesystem::path& folder, const std::vector<TableFile>& files)
{
    update_tables(folder, files);
    if (folder.empty())
        return;
    for (const TableFile& file : files)
        std::cout << (folder / file.name).string() << "\n";
}

void update_tables(const std::filesystem::path& folder, const std::vector<TableFile>& files)
{
    if (folder.empty())
        return;
    for (const TableFile& file : files)
        write_atomically(folder / file.name, file.content);
}

} // namespace toile::research
