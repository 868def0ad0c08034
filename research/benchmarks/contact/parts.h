#pragma once

#include <array>
#include <string_view>

#include "core/base/stages.h"

namespace toile::research::contact_stress {

/// Parts of the time of a step. Every stage belongs to one part, with its exclusive time only, so parts add
/// up to the step.
enum class Part {
    ClothPairs,        ///< search for pairs of cloth with cloth
    AvatarPairs,       ///< search for pairs of cloth with avatars and shapes
    TrajectoryLimiter, ///< the collision-free step
    Solve,             ///< solves with the factor, inside and outside conjugate gradients
    Pcg,               ///< conjugate gradients without these solves
    Minimise,          ///< the rest of the minimisation: energies, line search
    StrainLimit,
    Factor, ///< symbolic analysis and factoring, when attachments begin or end
    Rest,   ///< prediction, air, clearing, final friction, moving avatars
};

inline constexpr int kPartCount = 9;

/// [s] of each Part.
using PartSeconds = std::array<double, kPartCount>;

/// Column name, e.g. "cloth pairs".
const char* name_of(Part part);

/// Part that a stage belongs to, by its name.
Part part_of(std::string_view stage);

PartSeconds seconds_by_part(const Stages& stages);

/// a - b, part by part.
PartSeconds difference(const PartSeconds& a, const PartSeconds& b);

/// a += b, part by part.
void add(PartSeconds& a, const PartSeconds& b);

/// Time of all parts but Factor, which occurs a few times per run and not per step.
double step_seconds(const PartSeconds& parts);

inline double seconds_of(const PartSeconds& parts, Part part) { return parts[size_t(part)]; }

/// Time of the searches for pairs, with cloth and with avatars.
double detection_seconds(const PartSeconds& parts);

/// Time of the whole minimisation, solves included, collision-free step excluded.
double minimisation_seconds(const PartSeconds& parts);

} // namespace toile::research::contact_stress
