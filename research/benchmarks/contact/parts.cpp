#include "research/benchmarks/contact/parts.h"

#include <numeric>

namespace toile::research::contact_stress {

namespace {

struct Rule {
    std::string_view beginning; ///< prefix of a stage's name
    Part part;
};

/// Rules in order of priority: the first match counts.
constexpr Rule kRules[] = {
    {"collision/near_pairs", Part::ClothPairs},
    {"collision/search_again", Part::ClothPairs},
    {"collision/cloth_", Part::ClothPairs}, // the tree, its boxes, pairs, order, facing, terms
    {"collision/expect", Part::ClothPairs},
    {"collision/expect_remaining", Part::ClothPairs},
    {"collision/update_deviation", Part::ClothPairs},
    {"collision/collision_free_step", Part::TrajectoryLimiter},
    {"collision/max_safe_step", Part::TrajectoryLimiter},
    {"collision/record_expected", Part::TrajectoryLimiter},
    {"collision/displacements", Part::TrajectoryLimiter},
    {"collision/blocked", Part::TrajectoryLimiter},
    {"collision/keep_base", Part::TrajectoryLimiter},
    {"collision/widen_known", Part::TrajectoryLimiter},
    {"collision/recentre_known", Part::TrajectoryLimiter},
    {"collision/support", Part::TrajectoryLimiter},
    {"collision/overstretched_edges", Part::TrajectoryLimiter},
    {"collision/clearance", Part::AvatarPairs},
    {"collision/clear", Part::Rest},
    {"collision/resolve", Part::Rest},
    {"collision/", Part::AvatarPairs},
    {"contact/advect", Part::Rest},
    {"linear/solve", Part::Solve},
    {"linear/", Part::Factor},
    {"pd/pcg", Part::Pcg},
    {"pd/multiply", Part::Pcg},
    {"pd/nested", Part::Pcg},
    {"pd/contact_", Part::Pcg},
    {"contact/multiply", Part::Pcg},
    {"pd/predict", Part::Rest},
    {"pd/finish", Part::Rest},
    {"pd/", Part::Minimise},
    {"contact/", Part::Minimise},
    {"outer/", Part::Minimise},
    {"lbfgs/", Part::Minimise},
    {"newton/", Part::Minimise},
    {"field/", Part::Minimise}, // a few per cent of it, of PCG and the outer method alike
    {"garment/strain_limit", Part::StrainLimit},
    {"strain_limit/", Part::StrainLimit},
    {"garment/aerodynamics", Part::Rest},
    {"garment/gusts", Part::Rest},
    {"garment/", Part::Minimise},
    {"membrane/", Part::Minimise},
    {"bending/", Part::Minimise},
    {"stretch_tension/", Part::Minimise},
};

} // namespace

const char* name_of(Part part)
{
    static constexpr const char* kNames[kPartCount] = {"cloth pairs",  "avatar pairs", "bring back",
                                                       "solve",        "pcg",          "minimise",
                                                       "strain limit", "factor",       "rest"};
    return kNames[size_t(part)];
}

Part part_of(std::string_view stage)
{
    for (const Rule& rule : kRules)
        if (stage.starts_with(rule.beginning))
            return rule.part;
    return Part::Rest;
}

PartSeconds seconds_by_part(const Stages& stages)
{
    PartSeconds parts{};
    for (const auto& [name, entry] : stages.entries())
        parts[size_t(part_of(name))] += entry.self_seconds;
    return parts;
}

PartSeconds difference(const PartSeconds& a, const PartSeconds& b)
{
    PartSeconds result{};
    for (int i = 0; i < kPartCount; ++i)
        result[i] = a[i] - b[i];
    return result;
}

void add(PartSeconds& a, const PartSeconds& b)
{
    for (int i = 0; i < kPartCount; ++i)
        a[i] += b[i];
}

double step_seconds(const PartSeconds& parts)
{
    return std::accumulate(parts.begin(), parts.end(), 0.0) - seconds_of(parts, Part::Factor);
}

double detection_seconds(const PartSeconds& parts)
{
    return seconds_of(parts, Part::ClothPairs) + seconds_of(parts, Part::AvatarPairs);
}

double minimisation_seconds(const PartSeconds& parts)
{
    return seconds_of(parts, Part::Minimise) + seconds_of(parts, Part::Pcg) + seconds_of(parts, Part::Solve);
}

} // namespace toile::research::contact_stress
