#include "core/base/cancellation.h"

#include "core/base/error.h"

namespace toile {

namespace {
thread_local const std::function<bool()>* asked = nullptr;
} // namespace

Cancellation::Scope::Scope(const std::function<bool()>& goes_on) : previous_(asked) { asked = &goes_on; }
Cancellation::Scope::~Scope() { asked = previous_; }

void Cancellation::check()
{
    if (asked != nullptr && *asked && !(*asked)())
        throw Cancelled("interrupted");
}

} // namespace toile
