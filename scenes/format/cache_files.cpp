#include "scenes/format/cache_files.h"

#include <nlohmann/json.hpp>

#include "core/base/extension.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/sequence/numbered_files.h"
#include "scenes/format/document.h"
#include "scenes/format/names.h"

namespace toile::scene_format {

namespace {

bool is_sequence(const std::filesystem::path& cache)
{
    return exports::mesh_path_of(cache).empty() && exports::NumberedFiles::has_digits_placeholder(cache);
}

} // namespace

bool is_cache(const std::filesystem::path& file)
{
    const std::optional<exports::CacheFormat> format = exports::known_cache_format(file);
    if (!format || !exports::features_of(*format).read_back)
        return false;
    return *format != exports::CacheFormat::Obj || is_sequence(file);
}

bool has_times(const std::filesystem::path& cache)
{
    const exports::CacheFormat format = exports::cache_format(cache);
    return exports::features_of(format).several || format == exports::CacheFormat::Mdd;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& file)
{
    if (!is_sequence(file))
        return {exports::archive_of(file)};
    const exports::NumberedFiles sequence(file);
    std::vector<std::filesystem::path> files;
    for (const int number : sequence.existing())
        files.push_back(sequence.file(number));
    return files;
}

std::filesystem::path existing_cache(const Document& document, const std::filesystem::path& file,
                                     const std::string& key_path)
{
    if (is_sequence(file)) {
        const std::filesystem::path pattern = document.path_of(file.string(), key_path);
        if (exports::NumberedFiles(pattern).existing().empty())
            document.refuse(key_path, "no file of the sequence " + as_written(pattern.string()) +
                                          " exists; each # stands for a digit, from the first frame on");
        return pattern;
    }
    const std::string mesh = exports::mesh_path_of(file);
    const std::filesystem::path existing =
        document.existing_file(exports::archive_of(file).string(), key_path);
    return mesh.empty() ? existing.string() : existing.string() + "#" + mesh;
}

} // namespace toile::scene_format
