#include "core/base/stages.h"

#include <utility>

namespace toile {

namespace {
thread_local Stages* active_stages = nullptr;

/// Time of the stages that have ended inside the innermost open scope of this thread [s].
thread_local double nested_seconds = 0.0;
} // namespace

Stages::Activate::Activate(Stages& stages) : previous_(active_stages) { active_stages = &stages; }
Stages::Activate::~Activate() { active_stages = previous_; }

Stages* Stages::active() { return active_stages; }

void Stages::add(std::string_view name, double seconds, double self_seconds)
{
    auto entry = entries_.find(name);
    if (entry == entries_.end())
        entry = entries_.emplace(std::string(name), Entry{}).first;
    ++entry->second.calls;
    entry->second.seconds += seconds;
    entry->second.self_seconds += self_seconds;
}

long Stages::calls(std::string_view name) const
{
    const auto entry = entries_.find(name);
    return entry == entries_.end() ? 0 : entry->second.calls;
}

double Stages::seconds(std::string_view name) const
{
    const auto entry = entries_.find(name);
    return entry == entries_.end() ? 0.0 : entry->second.seconds;
}

StageScope::StageScope(std::string_view name)
    : name_(name), nested_before_(std::exchange(nested_seconds, 0.0)), start_(Clock::now())
{
}

StageScope::~StageScope()
{
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (Stages* stages = Stages::active())
        stages->add(name_, seconds, seconds - nested_seconds);
    nested_seconds = nested_before_ + seconds;
}

} // namespace toile
