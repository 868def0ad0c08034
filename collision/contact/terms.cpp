#include "collision/contact/terms.h"

#include "collision/body/collider_pairs.h"

namespace toile::collision {

ContactRules rules_of(const StepStart& start, const ContactTerms::Settings& settings)
{
    ContactRules rules;
    rules.x = start.x;
    rules.diagonal = start.diagonal;
    rules.fixed = start.fixed;
    rules.stiffness = settings.stiffness;
    rules.max_recovery = settings.recovery_speed * start.dt;
    rules.max_motion = ColliderPairs::kMaxAdvectionSpeed * start.dt;
    return rules;
}

ProjectionRules projection_rules_of(const StepStart& start)
{
    ProjectionRules rules;
    rules.fixed = start.fixed;
    rules.masses = start.masses;
    rules.dt = start.dt;
    rules.max_motion = ColliderPairs::kMaxAdvectionSpeed * start.dt;
    return rules;
}

} // namespace toile::collision
