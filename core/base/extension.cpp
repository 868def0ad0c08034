#include "core/base/extension.h"

#include <algorithm>
#include <cctype>

namespace toile {

std::string lower_case_extension(const std::filesystem::path& file)
{
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return char(std::tolower(letter)); });
    return extension;
}

} // namespace toile
