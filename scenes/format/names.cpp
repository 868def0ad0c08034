#include "scenes/format/names.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <nlohmann/json.hpp>

namespace toile::scene_format {

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

void require_known(const Document& document, const std::string& key_path, const std::string& kind,
                   const std::string& name, const std::vector<std::string>& names)
{
    if (contains(names, name))
        return;
    const std::string near = did_you_mean(name, names);
    const std::string known = names.empty() ? "; there is none" : "; known are " + enumerate(names, "and");
    document.refuse(key_path, "no " + kind + " is named " + as_written(name) + (near.empty() ? known : near));
}

void check_names(const Document& document, const std::string& list, const std::vector<std::string>& names)
{
    std::set<std::string> seen;
    for (size_t i = 0; i < names.size(); ++i) {
        const std::string& name = names[i];
        const std::string key_path = below(below(list, i), "name");
        const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
            return std::isalnum(c) != 0 || c == '_' || c == '-';
        });
        if (name.empty() || !plain)
            document.refuse(key_path, as_written(name) + " can't name a file; use letters, digits, _ and -");
        if (!seen.insert(name).second)
            document.refuse(key_path,
                            as_written(name) + " is taken by an earlier entry; choose another name");
    }
}

} // namespace toile::scene_format
