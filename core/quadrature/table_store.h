#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/backend/shared_by_key.h"
#include "core/quadrature/quadrature_tables.h"
#include "core/quadrature/table_cache.h"

namespace toile {

/// Identifies tables: everything in the input, bit by bit, and what else decides their bits (the version of
/// their making, compiler and instruction set).
Hash128 table_key(const TableInput& input);

/// Hears of tables that are being prepared. Calls come from the thread that asked or from those that build.
struct TableListener {
    /// Finished share; stays 0 while another thread builds the same tables. Returning false cancels. May be
    /// empty.
    BuildProgress progress = nullptr;
    TableCache::Warn warn =
        nullptr; ///< hears of cache files that are damaged or cannot be written; may be empty
};

/// Where solvers get their tables from: equal bodies share one, which is built once and freed with its last
/// user. With a folder it also keeps them for the next run. Safe to call from several threads.
class TableStore {
public:
    /// @param folder  of the cache on disk; empty: none
    explicit TableStore(const std::filesystem::path& folder = {},
                        std::uintmax_t byte_limit = TableCache::kByteLimit);

    /// The one that all solvers of the process use unless told otherwise, with default_cache_folder().
    static const std::shared_ptr<TableStore>& of_process();

    /// The tables of `input`: those in use, else read from the cache, else built ("quadrature/build") and
    /// written there. Who asks while another thread prepares them waits.
    /// @throws InvalidInput where H is not positive definite, Cancelled where the listener wants no more
    std::shared_ptr<const QuadratureTables> get(const TableInput& input, const TableListener& listener = {});

    /// As get(), but null where they would have to be built.
    std::shared_ptr<const QuadratureTables> find(const TableInput& input, const TableListener& listener = {});

    /// True where get() would most likely not build: the tables are in use, or the cache has a file for them.
    /// Costs a hash of the input.
    bool holds(const TableInput& input) const;

private:
    bool holds(const Hash128& key) const;
    std::shared_ptr<const QuadratureTables> prepare(const Hash128& key, const TableInput& input,
                                                    const TableListener& listener, bool may_build);

    std::optional<TableCache> cache_;
    SharedByKey<QuadratureTables> shared_;
};

} // namespace toile
