#pragma once

#include <array>
#include <string_view>

#include "core/backend/stages.h"

namespace toile::contact {

/// What the time of a step goes into. Every stage belongs to one part, with its own time only, so that parts
/// add up to the step.
enum class Part {
    ClothPairs,  ///< finding which cloth might meet cloth
    AvatarPairs, ///< finding which cloth might meet avatars and shapes
    BringBack,   ///< the step that never crosses
    Solve,       ///< solves with the factor, inside conjugate gradients and outside
    Pcg,         ///< conjugate gradients without these
    Minimise,    ///< the rest of the minimisation: energies, line search
    StrainLimit,
    Factor, ///< analysing and factoring, where holds begin or end
    Rest,   ///< prediction, air, clearing, friction's last word, moving avatars
};

inline constexpr int kPartCount = 9;

/// [s] of each Part.
using PartSeconds = std::array<double, kPartCount>;

/// A column's name, e.g. "cloth pairs".
const char* name_of(Part part);

/// The part that a stage belongs to, by its name.
Part part_of(std::string_view stage);

PartSeconds seconds_by_part(const Stages& stages);

/// a - b, part by part.
PartSeconds difference(const PartSeconds& a, const PartSeconds& b);

/// a += b, part by part.
void add(PartSeconds& a, const PartSeconds& b);

/// Of all parts but the factor's, which a run pays a few times and not per step.
double step_seconds(const PartSeconds& parts);

inline double seconds_of(const PartSeconds& parts, Part part) { return parts[size_t(part)]; }

/// Finding pairs, with cloth and with avatars.
double detection_seconds(const PartSeconds& parts);

/// The whole minimisation, its solves included, bringing back excluded.
double minimisation_seconds(const PartSeconds& parts);

} // namespace toile::contact
