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

void FilePlan::add_output(const std::filesystem::path& file, const std::string& role)
{
    if (is_stream(file))
        return;
    const Identity identity = identity_of(file);
    for (const std::string& key : {identity.by_name, identity.by_inode}) {
        if (key.empty())
            continue;
        const auto [other, is_new] = uses_.try_emplace(key, Use{file, role, false});
        if (is_new)
            continue;
        const Use& use = other->second;
        if (use.is_input)
            throw InvalidInput(file.string() + ": " + role + " would replace " + use.file.string() + ", " +
                               use.role + "; choose another folder or name");
        throw InvalidInput(file.string() + ": would be both " + use.role + " (" + use.file.string() +
                           ") and " + role + "; give each a name of its own");
    }
}

} // namespace toile
