#include "core/quadrature/tables/background_tables.h"

#include <chrono>
#include <utility>

#include "core/base/error.h"
#include "core/compute/low_priority.h"

namespace toile {

namespace {

/// Process-wide lock that allows one build at a time. Otherwise each body would take a thread from the
/// simulation, and equal bodies only to wait for each other.
class BuildLock {
public:
    /// @throws Cancelled if `progress` cancels
    explicit BuildLock(const BuildProgress& progress)
    {
        while (!lock_.try_lock_for(kPoll))
            if (!progress(0.0))
                throw Cancelled("waiting for other quadrature tables was cancelled");
    }

private:
    static constexpr std::chrono::milliseconds kPoll{20};

    static std::timed_mutex& mutex()
    {
        static std::timed_mutex of_process;
        return of_process;
    }

    std::unique_lock<std::timed_mutex> lock_{mutex(), std::defer_lock};
};

} // namespace

BackgroundTables::BackgroundTables(std::shared_ptr<TableStore> store, int threads, TableCache::Warn warn)
    : store_(std::move(store)), threads_(threads), warn_(std::move(warn))
{
}

BackgroundTables::~BackgroundTables() = default; // asks the thread to stop and joins it

void BackgroundTables::ask(std::optional<Request> request)
{
    const std::lock_guard lock(mutex_);
    ++number_;
    request_ = std::move(request);
    ready_ = nullptr;
    failure_ = nullptr;
    fraction_ = 0.0;
}

void BackgroundTables::start(Request request)
{
    ask(std::move(request));
    changed_.notify_all();
    if (!thread_.joinable())
        thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

void BackgroundTables::cancel() { ask(std::nullopt); }

std::shared_ptr<const QuadratureTables> BackgroundTables::take_if_ready()
{
    const std::lock_guard lock(mutex_);
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(ready_, nullptr);
}

void BackgroundTables::work(const std::stop_token& stop)
{
    for (;;) {
        std::optional<Request> request;
        long number = 0;
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [&] { return request_.has_value(); }))
                return;
            request = std::exchange(request_, std::nullopt);
            number = number_;
        }
        prepare(*request, number, stop);
    }
}

void BackgroundTables::prepare(const Request& request, long number, const std::stop_token& stop)
{
    const auto progress = [&](double fraction) {
        const std::lock_guard lock(mutex_);
        const bool is_wanted = !stop.stop_requested() && number == number_;
        if (is_wanted)
            fraction_ = fraction;
        return is_wanted;
    };
    std::shared_ptr<const QuadratureTables> tables;
    std::exception_ptr failure;
    try {
        std::vector<EmbeddedPoint> points;
        with_low_priority(kCpu, threads_, [&] {
            points = request.points();
            if (progress(0.0))
                tables =
                    store_->find({request.H, request.fixed, points, request.settings}, {progress, warn_});
        });
        if (!tables && !request.only_stored) {
            const BuildLock build_lock(progress);
            with_low_priority(kCpu, threads_, [&] {
                tables = store_->get({request.H, request.fixed, points, request.settings}, {progress, warn_});
            });
        }
    } catch (const Cancelled&) {
        return;
    } catch (...) {
        failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (number != number_)
        return;
    ready_ = std::move(tables);
    failure_ = failure;
    fraction_ = 1.0;
}

} // namespace toile
