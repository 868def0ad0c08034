#include "export/usd/usd_files.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <system_error>

#include "core/base/atomic_file.h"

namespace toile::exports {

namespace {

/// Whether a file's name without the extension is that of a clip or a manifest.
bool is_of_cache(const std::string& name, const std::string& stem)
{
    if (!name.starts_with(stem + "."))
        return false;
    const std::string rest = name.substr(stem.size() + 1);
    return rest == "manifest" ||
           (rest.size() >= 4 &&
            std::all_of(rest.begin(), rest.end(), [](unsigned char c) { return std::isdigit(c) != 0; }));
}

} // namespace

int usd_clip_count(int sample_count)
{
    return sample_count <= kUsdSamplesPerFile ? 0 : (sample_count - 2) / kUsdSamplesPerFile + 1;
}

std::filesystem::path UsdFiles::clip_folder() const { return root_.parent_path() / (stem() + "_clips"); }

std::filesystem::path UsdFiles::clip(int number) const
{
    char digits[16];
    std::snprintf(digits, sizeof digits, ".%04d", number);
    return clip_folder() / (stem() + digits + ".usda");
}

std::filesystem::path UsdFiles::manifest() const { return clip_folder() / (stem() + ".manifest.usda"); }

std::string UsdFiles::asset(const std::filesystem::path& file) const
{
    return "./" + file.lexically_relative(root_.parent_path()).string();
}

std::vector<std::filesystem::path> UsdFiles::existing() const
{
    std::vector<std::filesystem::path> files;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(clip_folder(), missing)) {
        const std::filesystem::path name = entry.path().filename();
        const bool is_whole = name.extension() == ".usda" && is_of_cache(name.stem().string(), stem());
        if (is_whole || (is_partial(name) && name.string().starts_with(stem() + ".")))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

void UsdFiles::remove_clips() const
{
    std::error_code not_empty;
    for (const std::filesystem::path& file : existing())
        std::filesystem::remove(file, not_empty);
    std::filesystem::remove(clip_folder(), not_empty);
}

UsdFiles unfinished_usd(const std::filesystem::path& file, int sample_count)
{
    if (usd_clip_count(sample_count) == 0)
        return UsdFiles(partial_beside(file));
    return UsdFiles(file.parent_path() / (file.stem().string() + ".partial") / file.filename());
}

} // namespace toile::exports
