#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/backend/hash.h"
#include "core/quadrature/quadrature_tables.h"

namespace toile {

/// Where caches go: $TOILE_CACHE_DIR, else $XDG_CACHE_HOME/toile, else ~/.cache/toile. Empty, and so no
/// cache, where TOILE_CACHE_DIR is set to nothing or there is no home.
std::filesystem::path default_cache_folder();

/// Finished tables on disk, one file per key: what takes seconds to build is read in milliseconds by the next
/// run. A file that is damaged, old, or of another key is as good as none and is written anew. Threads and
/// processes may share the folder.
class TableCache {
public:
    /// Told what went wrong without stopping the work, a sentence each; may be empty.
    using Warn = std::function<void(const std::string&)>;

    /// [bytes] of all files together; beyond it those not used for longest go.
    static constexpr std::uintmax_t kByteLimit = 2'000'000'000;

    explicit TableCache(const std::filesystem::path& folder, std::uintmax_t byte_limit = kByteLimit);

    /// Reads the kernel of `tables`, whose tree and basis are there ("quadrature/load"), and notes the use.
    /// @return false where there is none that fits
    bool load(const Hash128& key, QuadratureTables& tables, const Warn& warn) const;

    /// Keeps `tables`, unless they alone are beyond the limit. The first folder or file that cannot be
    /// written is warned of and ends all writing.
    void store(const Hash128& key, const QuadratureTables& tables, const Warn& warn);

    /// True where there is a file for `key`, whatever is in it.
    bool has_file(const Hash128& key) const;

    std::filesystem::path file_of(const Hash128& key) const;

private:
    void forget_least_used() const;

    std::filesystem::path folder_;
    std::uintmax_t byte_limit_;
    std::atomic<bool> is_writable_ = true;
};

} // namespace toile
