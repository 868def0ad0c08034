#pragma once

#include <functional>

#include "core/base/cancellation.h"

namespace toile::collision {

/// Reports how far a repair is, or a part of it.
class RepairProgress {
public:
    /// @param report  receives the finished fraction [0, 1]; may be empty
    explicit RepairProgress(std::function<void(double)> report) : report_(std::move(report)) {}

    /// The part between two fractions of this one.
    RepairProgress part(double begin, double end) const
    {
        RepairProgress result = *this;
        result.begin_ = begin_ + begin * (end_ - begin_);
        result.end_ = begin_ + end * (end_ - begin_);
        return result;
    }

    /// @throws Cancelled if the repair shall end (Cancellation)
    void update(double fraction) const
    {
        Cancellation::check();
        if (report_)
            report_(begin_ + fraction * (end_ - begin_));
    }

private:
    std::function<void(double)> report_;
    double begin_ = 0.0, end_ = 1.0;
};

} // namespace toile::collision
