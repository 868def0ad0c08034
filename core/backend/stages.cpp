#include "core/backend/stages.h"

namespace toile {

namespace {
thread_local Stages* active_stages = nullptr;
}

Stages::Activate::Activate(Stages& stages) : previous_(active_stages) { active_stages = &stages; }
Stages::Activate::~Activate() { active_stages = previous_; }

Stages* Stages::active() { return active_stages; }

void Stages::add(std::string_view name, double seconds)
{
    auto entry = entries_.find(name);
    if (entry == entries_.end())
        entry = entries_.emplace(std::string(name), Entry{}).first;
    ++entry->second.calls;
    entry->second.seconds += seconds;
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

StageScope::~StageScope()
{
    if (Stages* stages = Stages::active())
        stages->add(name_, std::chrono::duration<double>(Clock::now() - start_).count());
}

} // namespace toile
