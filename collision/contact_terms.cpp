#include "collision/contact_terms.h"

#include "collision/collider_pairs.h"

namespace toile {

ContactRules rules_of(const StepStart& start, const ContactTerms::Settings& settings)
{
    ContactRules rules;
    rules.x = start.x;
    rules.diagonal = start.diagonal;
    rules.fixed = start.fixed;
    rules.stiffness = settings.stiffness;
    rules.farthest_recovery = settings.recovery_speed * start.dt;
    rules.farthest_motion = ColliderPairs::kMaxCarrySpeed * start.dt;
    return rules;
}

PushRules push_rules_of(const StepStart& start)
{
    PushRules rules;
    rules.fixed = start.fixed;
    rules.masses = start.masses;
    rules.dt = start.dt;
    rules.farthest_motion = ColliderPairs::kMaxCarrySpeed * start.dt;
    return rules;
}

} // namespace toile
