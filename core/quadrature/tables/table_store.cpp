#include "core/quadrature/tables/table_store.h"

#include "core/base/error.h"

namespace toile {

namespace {

/// Raise this when the same input would give other tables: trees, functions, lists, weights.
constexpr int kTableVersion = 1;

/// Compiler options that change the bits from the same source: fused products and the width of sums.
constexpr std::string_view kCompiledAs = __VERSION__
#ifdef __FMA__
    " fma"
#endif
#ifdef __AVX__
    " avx"
#endif
#ifdef __AVX512F__
    " avx512"
#endif
    ;

} // namespace

Hash128 table_key(const TableInput& input)
{
    const Hash128 matrix = hash_of(input.H);
    Hasher hasher;
    hasher.add(kTableVersion);
    hasher.add(kCompiledAs);
    hasher.add(matrix.high);
    hasher.add(matrix.low);
    hasher.add(input.fixed);
    hasher.add(input.points);
    hasher.add(input.settings.kernel.tolerance);
    hasher.add(rank_of(input.settings.extent));
    return hasher.result();
}

TableStore::TableStore(const std::filesystem::path& folder, std::uintmax_t byte_limit)
{
    if (!folder.empty())
        cache_.emplace(folder, byte_limit);
}

const std::shared_ptr<TableStore>& TableStore::of_process()
{
    static const auto store = std::make_shared<TableStore>(default_cache_folder());
    return store;
}

bool TableStore::contains(const TableInput& input) const { return contains(table_key(input)); }

bool TableStore::contains(const Hash128& key) const
{
    return shared_.contains(key) || (cache_ && cache_->has_file(key));
}

std::shared_ptr<const QuadratureTables> TableStore::get(const TableInput& input,
                                                        const TableListener& listener)
{
    return prepare(table_key(input), input, listener, true);
}

std::shared_ptr<const QuadratureTables> TableStore::find(const TableInput& input,
                                                         const TableListener& listener)
{
    const Hash128 key = table_key(input);
    return contains(key) ? prepare(key, input, listener, false) : nullptr;
}

/// Null if no tables exist and `may_build` is false.
std::shared_ptr<const QuadratureTables> TableStore::prepare(const Hash128& key, const TableInput& input,
                                                            const TableListener& listener, bool may_build)
{
    const auto make = [&]() -> std::shared_ptr<const QuadratureTables> {
        std::shared_ptr<QuadratureTables> tables = begin_tables(input);
        if (cache_ && cache_->load(key, *tables, listener.warn))
            return tables;
        if (!may_build)
            return nullptr;
        build_kernel(input, listener.progress, *tables);
        if (cache_)
            cache_->store(key, *tables, listener.warn);
        return tables;
    };
    const auto waiting = [&] {
        if (listener.progress && !listener.progress(0.0))
            throw Cancelled("waiting for quadrature tables was cancelled");
    };
    return shared_.get(key, make, waiting);
}

} // namespace toile
