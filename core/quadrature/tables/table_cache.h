#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/compute/hash.h"
#include "core/quadrature/tables/quadrature_tables.h"

namespace toile {

/// Folder of the caches: $TOILE_CACHE_DIR, else $XDG_CACHE_HOME/toile, else ~/.cache/toile. Empty (no cache)
/// if TOILE_CACHE_DIR is empty or there is no home.
std::filesystem::path default_cache_folder();

/// Finished tables on disk, one file per key: the next run reads in milliseconds what takes seconds to build.
/// A file that is damaged, of another version or of another key is ignored and rewritten. Threads and
/// processes may share the folder.
class TableCache {
public:
    /// Callback for failures that do not stop the work, one sentence each; may be empty.
    using Warn = std::function<void(const std::string&)>;

    /// [bytes] Limit for all files together; beyond it the least recently used ones are deleted.
    static constexpr std::uintmax_t kByteLimit = 2'000'000'000;

    explicit TableCache(const std::filesystem::path& folder, std::uintmax_t byte_limit = kByteLimit);

    /// Reads the kernel of `tables`, which has its tree and basis ("quadrature/load"), and marks the file as
    /// used.
    /// @return false if there is no matching file
    bool load(const Hash128& key, QuadratureTables& tables, const Warn& warn) const;

    /// Writes `tables`, unless they alone exceed the limit. The first folder or file that cannot be written
    /// gives a warning and ends all writing.
    void store(const Hash128& key, const QuadratureTables& tables, const Warn& warn);

    /// True if there is a file for `key`, whatever its content.
    bool has_file(const Hash128& key) const;

    std::filesystem::path file_of(const Hash128& key) const;

private:
    void forget_least_used() const;

    std::filesystem::path folder_;
    std::uintmax_t byte_limit_;
    std::atomic<bool> is_writable_ = true;
};

} // namespace toile
