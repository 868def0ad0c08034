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

#include "core/quadrature/tables/table_store.h"

namespace toile {

/// Tables that are read or built in the background, while the simulation uses another solver. The simulation
/// takes them between two steps:
///
///   BackgroundTables background;
///   background.start({H, fixed, [=] { return points; }, {}});
///   ... steps with a DirectSolver ...
///   if (auto tables = background.take_if_ready())
///       quadrature = QuadratureOperator(tables);
///
/// For one caller at a time. All objects of the process build one after the other. The time at which tables
/// become ready depends on the machine; their contents do not.
class BackgroundTables {
public:
    /// TableInput that owns its data.
    struct Request {
        SparseMatrix H;
        std::vector<unsigned char> fixed;
        std::function<std::vector<EmbeddedPoint>()> points; ///< called on the background thread
        QuadratureTables::Settings settings;
        bool only_stored = false; ///< true: no tables if the store would have to build them

        /// Kept until the request is done, so that the build reuses it instead of factoring; may be null.
        std::shared_ptr<const SupernodalFactor> factor = nullptr;
    };

    /// @param store    source and cache of the tables
    /// @param threads  maximum for a build. The first belongs to the object, in addition to the simulation's;
    ///                 the others are the simulation's, while it has no work for them.
    /// @param warn     called from the background thread; may be empty
    explicit BackgroundTables(std::shared_ptr<TableStore> store = TableStore::of_process(), int threads = 1,
                              TableCache::Warn warn = nullptr);

    /// Cancels and waits for the thread: at most one block of 32 columns, one factorisation, or the points.
    ~BackgroundTables();
    BackgroundTables(const BackgroundTables&) = delete;
    BackgroundTables& operator=(const BackgroundTables&) = delete;

    /// Requests tables and returns at once. Cancels the earlier request and drops its result.
    void start(Request request);

    /// Cancels the request, drops its result and returns at once.
    void cancel();

    /// Finished fraction [0, 1] of the last request.
    double progress() const { return fraction_; }

    /// Tables of the request, once; null while they are not ready, and again afterwards.
    /// @throws the exception of the build or of `points`, once: InvalidInput if H is not positive definite
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
    std::optional<Request> request_; ///< not yet started
    std::shared_ptr<const QuadratureTables> ready_;
    std::exception_ptr failure_;
    std::atomic<long> number_ = 0; ///< of the last request; earlier ones are cancelled
    std::atomic<double> fraction_ = 0.0;
    std::jthread thread_; ///< last: it uses all members above
};

} // namespace toile
