#pragma once

#include <string>
#include <vector>

#include "scenes/format/document.h"

/// Names within a scene: lists, uniqueness, and existence of names referred to.
namespace toile::scene_format {

/// Names of objects, in their order.
template <typename Object>
std::vector<std::string> names_of(const std::vector<Object>& objects)
{
    std::vector<std::string> names;
    names.reserve(objects.size());
    for (const Object& object : objects)
        names.push_back(object.name);
    return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name);

/// @throws InvalidInput if `name` is not in `names`: no cloth is named "skrit"; did you mean "skirt"?
void require_known(const Document& document, const std::string& key_path, const std::string& kind,
                   const std::string& name, const std::vector<std::string>& names);

/// Checks names that appear in messages and file names: letters, digits, _ and -; unique within their list.
/// @throws InvalidInput for the first invalid name.
void check_names(const Document& document, const std::string& list, const std::vector<std::string>& names);

} // namespace toile::scene_format
