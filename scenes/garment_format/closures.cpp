#include "scenes/garment_format/closures.h"

#include <nlohmann/json.hpp>

#include "scenes/format/names.h"
#include "scenes/garment_format/panel_point.h"

namespace toile::garment_format {
namespace {

using garment::Closure;
using garment::Pattern;
using scene_format::below;
using scene_format::Document;

/// Points of a panel nearer to each other are one [m].
constexpr double kOnePoint = 1e-6;

Closure closure_of(const Document& document, const std::string& key_path, const ClosureEntry& entry,
                   const Pattern& pattern)
{
    Closure closure;
    closure.a = panel_point_of(document, below(key_path, "a"), entry.a, pattern);
    closure.b = panel_point_of(document, below(key_path, "b"), entry.b, pattern);
    closure.close_at = entry.close_at;
    closure.name = key_path;
    if (closure.a.panel == closure.b.panel && (closure.a.point - closure.b.point).norm() < kOnePoint)
        document.refuse(key_path, "closes a point with itself; name two");
    return closure;
}

/// Adds a closure, and its images on copies of its panels.
void add_to_copies(const Closure& closure, const GarmentFile& file, Pattern& pattern)
{
    pattern.closures.push_back(closure);
    for (int k = 1;; ++k) {
        const auto a = on_copy(closure.a, k, file, pattern), b = on_copy(closure.b, k, file, pattern);
        if (!a || !b)
            return;
        pattern.closures.push_back(
            {*a, *b, closure.close_at, closure.name + " of copy " + std::to_string(k + 1)});
    }
}

} // namespace

void add_closures(const Document& document, const GarmentFile& file, Pattern& pattern)
{
    for (size_t i = 0; i < file.closures.size(); ++i)
        add_to_copies(closure_of(document, below("closures", i), file.closures[i], pattern), file, pattern);
}

} // namespace toile::garment_format
