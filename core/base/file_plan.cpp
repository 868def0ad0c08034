#include "core/base/file_plan.h"

#include <sys/stat.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace toile {

FilePlan::Identity FilePlan::identity_of(const std::filesystem::path& file)
{
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    const auto [known, is_new] = canonical_folders_.try_emplace(folder);
    if (is_new) {
        std::error_code unreadable;
        known->second = std::filesystem::weakly_canonical(folder, unreadable);
        if (unreadable)
            known->second = folder.lexically_normal();
    }
    Identity identity{(known->second / file.filename()).string(), ""};
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0)
        identity.by_inode = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
    return identity;
}

void FilePlan::add_input(const std::filesystem::path& file, const std::string& role)
{
    const Identity identity = identity_of(file);
    uses_.try_emplace(identity.by_name, Use{file, role, true});
    if (!identity.by_inode.empty())
        uses_.try_emplace(identity.by_inode, Use{file, role, true});
}

void FilePlan::refuse(const Use& use, const Use& earlier)
{
    if (earlier.is_input)
        throw InvalidInput(use.file.string() + ": " + use.role + " would replace " + earlier.file.string() +
                           ", " + earlier.role + "; choose another folder or name");
    throw InvalidInput(use.file.string() + ": " + use.role + " is in the way of " + earlier.file.string() +
                       ", " + earlier.role + "; give each a name of its own");
}

/// Notes the folders that an output needs, unless those of its neighbours are noted already.
void FilePlan::add_folders_above(const std::string& name, const Use& use)
{
    for (std::filesystem::path folder = std::filesystem::path(name).parent_path();
         folder.has_relative_path() && folders_.try_emplace(folder.string(), use).second;
         folder = folder.parent_path())
        if (const auto file = uses_.find(folder.string()); file != uses_.end() && !file->second.is_input)
            refuse(use, file->second);
}

void FilePlan::add_output(const std::filesystem::path& file, const std::string& role)
{
    if (is_stream(file))
        return;
    const Use use{file, role, false};
    const Identity identity = identity_of(file);
    for (const std::string& key : {identity.by_name, identity.by_inode})
        if (!key.empty())
            if (const auto [earlier, is_new] = uses_.try_emplace(key, use); !is_new)
                refuse(use, earlier->second);
    if (const auto within = folders_.find(identity.by_name); within != folders_.end())
        refuse(use, within->second);
    add_folders_above(identity.by_name, use);
}

} // namespace toile
