#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/quadrature/table_store.h"

namespace toile {

/// Tables that are read or built beside the simulation, which goes on with another solver meanwhile and takes
/// them between two steps:
///
///   BackgroundTables background;
///   background.start({H, fixed, [=] { return places; }, {}});
///   ... steps with a DirectSolver ...
///   if (auto tables = background.take_if_ready())
///       quadrature = QuadratureOperator(tables);
///
/// For one caller at a time. All objects of the process build one after the other. When tables become ready
/// depends on the machine; what they hold does not.
class BackgroundTables {
public:
    /// A TableInput that owns what it is made of.
    struct Request {
        SparseMatrix H;
        std::vector<unsigned char> fixed;
        std::function<std::vector<Place>()> places; ///< called on the own thread
        QuadratureTables::Settings settings;
        bool only_at_hand = false; ///< tables that the store would have to build do not come

        /// Kept until the request is done, so that building shares it instead of factoring; may be null.
        std::shared_ptr<const SupernodalFactor> factor = nullptr;
    };

    /// @param store    where tables come from and are kept
    /// @param threads  that build at most. The first is the object's own, on top of those that simulate; the
    ///                 others are lent by the simulation while it has nothing for them.
    /// @param warn     called from the own thread; may be empty
    explicit BackgroundTables(std::shared_ptr<TableStore> store = TableStore::of_process(), int threads = 1,
                              TableCache::Warn warn = nullptr);

    /// Cancels and waits for the thread: for the rest of a block of 32 columns, of a factorisation, or of the
    /// places.
    ~BackgroundTables();
    BackgroundTables(const BackgroundTables&) = delete;
    BackgroundTables& operator=(const BackgroundTables&) = delete;

    /// Asks for tables and returns at once. What was asked for before is cancelled and forgotten, ready or
    /// not.
    void start(Request request);

    /// Cancels and forgets what was asked for, and returns at once.
    void cancel();

    /// Finished share [0, 1] of what was asked for last.
    double progress() const { return share_; }

    /// The tables, once; null while they are not ready, and again afterwards.
    /// @throws what building them threw, or the places, once: InvalidInput where H is not positive definite
    std::shared_ptr<const QuadratureTables> take_if_ready();

private:
    void work(const std::stop_token& stop);
    void ask(std::optional<Request> request);
    void prepare(const Request& request, long number, const std::stop_token& stop);

    std::shared_ptr<TableStore> store_;
    int threads_;
    TableCache::Warn warn_;

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::optional<Request> request_; ///< not yet begun
    std::shared_ptr<const QuadratureTables> ready_;
    std::exception_ptr failure_;
    std::atomic<long> number_ = 0; ///< of the request asked for last; earlier ones are cancelled
    std::atomic<double> share_ = 0.0;
    std::jthread thread_; ///< last: it uses all of the above
};

} // namespace toile
