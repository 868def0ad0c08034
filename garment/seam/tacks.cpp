#include "garment/seam/tacks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::garment {

namespace {

std::vector<Sewing::Thread> threads_of(const std::vector<Tacks::Tack>& tacks)
{
    std::vector<Sewing::Thread> threads;
    threads.reserve(tacks.size());
    for (const Tacks::Tack& tack : tacks)
        threads.push_back({tack.a, tack.b});
    return threads;
}

} // namespace

Tacks::Tacks(const std::vector<Tack>& tacks)
    : threads_(std::make_shared<Sewing>(threads_of(tacks), Sewing::Settings{kStiffness, kMaxForce}))
{
    for (size_t i = 0; i < tacks.size(); ++i) {
        closings_.push_back({tacks[i].close_at, 0.0, 0.0});
        threads_->set_length(int(i), std::numeric_limits<double>::infinity());
    }
}

void Tacks::begin_step(double t_t1, View<const Vec3> x)
{
    for (int i = 0; i < int(closings_.size()); ++i) {
        Closing& closing = closings_[size_t(i)];
        if (!closing.has_begun(t_t1)) { // or a step that had begun it was not taken
            threads_->set_length(i, std::numeric_limits<double>::infinity());
            continue;
        }
        if (std::isinf(threads_->length(i)) || t_t1 < closing.start) {
            const auto& [a, b] = threads_->threads()[size_t(i)];
            closing.start = t_t1;
            closing.gap = (x[a] - x[b]).norm();
        }
        threads_->set_length(i, std::max(0.0, closing.gap - kSpeed * (t_t1 - closing.start)));
    }
}

bool Tacks::are_closing(double t) const
{
    for (int i = 0; i < int(closings_.size()); ++i)
        if (closings_[size_t(i)].has_begun(t) && threads_->length(i) > 0.0)
            return true;
    return false;
}

} // namespace toile::garment
