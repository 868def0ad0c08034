#include "core/base/long_work.h"

#include <utility>

#include "core/base/cancellation.h"

namespace toile {

namespace {
thread_local LongWork::Scope* active = nullptr;
} // namespace

LongWork::Scope::Scope(Report report) : report_(std::move(report)), previous_(std::exchange(active, this)) {}
LongWork::Scope::~Scope() { active = previous_; }

LongWork::Part::Part(double begin, double end)
    : begin_(active != nullptr ? active->begin_ : 0.0), end_(active != nullptr ? active->end_ : 1.0)
{
    if (active == nullptr)
        return;
    active->begin_ = begin_ + begin * (end_ - begin_);
    active->end_ = begin_ + end * (end_ - begin_);
}

LongWork::Part::~Part()
{
    if (active == nullptr)
        return;
    active->begin_ = begin_;
    active->end_ = end_;
}

void LongWork::update(double fraction)
{
    Cancellation::check();
    if (active != nullptr)
        active->report_({active->begin_ + fraction * (active->end_ - active->begin_), 0});
}

void LongWork::iterate(int iteration)
{
    Cancellation::check();
    if (active != nullptr)
        active->report_({active->begin_, iteration});
}

} // namespace toile
