#include "core/quadrature/tables/table_cache.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/stages.h"
#include "core/quadrature/tables/table_file.h"

namespace toile {

namespace {

constexpr const char* kExtension = ".tables";

/// Age at which unfinished files count as left behind by ended processes.
constexpr std::chrono::hours kAbandoned(24);

/// True for finished or unfinished tables, by the name that file_of() gives them.
bool is_ours(const std::filesystem::path& file)
{
    constexpr size_t kDigits = 32;
    const std::string name = file.filename().string();
    return name.find_first_not_of("0123456789abcdef") == kDigits &&
           name.compare(kDigits, std::string_view(kExtension).size(), kExtension) == 0;
}

std::filesystem::path path_in(const char* variable)
{
    const char* value = std::getenv(variable);
    return value != nullptr ? value : "";
}

std::uintmax_t bytes_of(const KernelTable& kernel)
{
    return sizeof(int) * (kernel.near_first.size() + kernel.near_leaf.size() + kernel.far_first.size() +
                          kernel.far_cluster.size()) +
           sizeof(float) * (kernel.near_weights.size() + kernel.far_weights.size());
}

} // namespace

std::filesystem::path default_cache_folder()
{
    if (std::getenv("TOILE_CACHE_DIR") != nullptr)
        return path_in("TOILE_CACHE_DIR");
    // Relative paths are to be ignored [XDG Base Directory Specification].
    if (const std::filesystem::path caches = path_in("XDG_CACHE_HOME"); caches.is_absolute())
        return caches / "toile";
    if (const std::filesystem::path home = path_in("HOME"); home.is_absolute())
        return home / ".cache" / "toile";
    return {};
}

TableCache::TableCache(const std::filesystem::path& folder, std::uintmax_t byte_limit)
    : folder_(std::filesystem::absolute(folder)), byte_limit_(byte_limit)
{
}

std::filesystem::path TableCache::file_of(const Hash128& key) const
{
    return folder_ / (to_hex(key) + kExtension);
}

bool TableCache::has_file(const Hash128& key) const
{
    std::error_code ignored;
    return std::filesystem::is_regular_file(file_of(key), ignored);
}

bool TableCache::load(const Hash128& key, QuadratureTables& tables, const Warn& warn) const
{
    const std::filesystem::path file = file_of(key);
    if (!has_file(key))
        return false;
    const StageScope stage("quadrature/load");
    const TableFileOutcome outcome = read_table_file(file, key, tables);
    if (outcome.status == TableFileOutcome::Status::Corrupt && warn)
        warn(file.string() + ": " + outcome.reason + "; the tables are built anew");
    if (outcome.status != TableFileOutcome::Status::Read)
        return false;
    std::error_code ignored;
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);
    return true;
}

void TableCache::store(const Hash128& key, const QuadratureTables& tables, const Warn& warn)
{
    if (!is_writable_ || bytes_of(tables.kernel) > byte_limit_)
        return;
    try {
        write_table_file(file_of(key), key, tables);
        forget_least_used();
    } catch (const std::runtime_error& error) {
        if (is_writable_.exchange(false) && warn)
            warn(std::string(error.what()) + "; quadrature tables are not kept for the next run");
    }
}

/// Deletes the least recently used files beyond the limit. Files that disappear meanwhile were deleted by
/// another process with the same limit.
void TableCache::forget_least_used() const
{
    struct File {
        std::filesystem::file_time_type used;
        std::uintmax_t bytes;
        std::filesystem::path path;
    };
    std::vector<File> files;
    std::uintmax_t total = 0;
    const auto now = std::filesystem::file_time_type::clock::now();
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code gone;
        const File file{entry->last_write_time(gone), entry->file_size(gone), entry->path()};
        if (gone || !is_ours(file.path))
            continue;
        if (is_partial(file.path) && now - file.used > kAbandoned)
            std::filesystem::remove(file.path, gone);
        if (file.path.extension() != kExtension)
            continue;
        files.push_back(file);
        total += file.bytes;
    }
    std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
    for (const File& file : files) {
        if (total <= byte_limit_)
            break;
        std::filesystem::remove(file.path, error);
        if (!error)
            total -= file.bytes;
    }
}

} // namespace toile
