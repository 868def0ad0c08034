#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/compute/shared_by_key.h"
#include "core/quadrature/tables/quadrature_tables.h"
#include "core/quadrature/tables/table_cache.h"

namespace toile {

/// Identifies tables: every bit of the input, and what else determines their bits (table version, compiler,
/// instruction set).
Hash128 table_key(const TableInput& input);

/// Callbacks while tables are prepared, from the requesting thread or from building threads.
struct TableListener {
    /// Finished fraction; stays 0 while another thread builds the same tables. Returning false cancels. May
    /// be empty.
    BuildProgress progress = nullptr;
    /// Called for cache files that are damaged or cannot be written; may be empty.
    TableCache::Warn warn = nullptr;
};

/// Shared source of tables: equal bodies share one object, which is built once and freed with its last user.
/// With a folder, tables are kept for the next run. Safe to call from several threads.
class TableStore {
public:
    /// @param folder  of the cache on disk; empty: none
    explicit TableStore(const std::filesystem::path& folder = {},
                        std::uintmax_t byte_limit = TableCache::kByteLimit);

    /// Default store of all solvers of the process, with default_cache_folder().
    static const std::shared_ptr<TableStore>& of_process();

    /// Tables of `input`: shared ones in use, else read from the cache, else built ("quadrature/build") and
    /// written to the cache. Waits if another thread is preparing them.
    /// @throws InvalidInput if H is not positive definite, Cancelled if the listener cancels
    std::shared_ptr<const QuadratureTables> get(const TableInput& input, const TableListener& listener = {});

    /// Tables as from get(), but null if they would have to be built.
    std::shared_ptr<const QuadratureTables> find(const TableInput& input, const TableListener& listener = {});

    /// True if get() would most likely not build: the tables are in use, or the cache has a file for them.
    /// Costs a hash of the input.
    bool contains(const TableInput& input) const;

private:
    bool contains(const Hash128& key) const;
    std::shared_ptr<const QuadratureTables> prepare(const Hash128& key, const TableInput& input,
                                                    const TableListener& listener, bool may_build);

    std::optional<TableCache> cache_;
    SharedByKey<QuadratureTables> shared_;
};

} // namespace toile
