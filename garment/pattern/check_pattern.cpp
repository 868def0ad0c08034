#include "garment/pattern/check_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/number.h"
#include "garment/pattern/check_panel.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/seam_side.h"

namespace toile::garment {
namespace {

/// [m] A garment has a panel that is longer than a hand, and none as long as a house.
constexpr double kMinPanel = 0.15;
constexpr double kMaxPanel = 6.0;

/// [-] Longer over shorter side of a seam. Ruffles have 3 at most.
constexpr double kMaxRatio = 4.0;

/// [-] Parts of an edge may overlap by that fraction: rounding of the file.
constexpr double kOverlap = 1e-6;

/// Longer side of the box about a panel's corners [m].
double size_of(const Panel& panel)
{
    Vec2 lower = panel.corners.front();
    Vec2 upper = lower;
    for (const Vec2& corner : panel.corners) {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
    }
    return (upper - lower).maxCoeff();
}

/// Factor on units_in_meter with which the largest panel has a likely size.
std::string likely_unit(double size)
{
    for (const double factor : {100.0, 0.01, 10.0, 0.1, 1000.0, 0.001})
        if (size / factor > 0.3 && size / factor < 3.0)
            return ", with " + short_text(factor) + " times as many units in a metre it would have " +
                   short_text(size / factor) +
                   " m: properties.units_in_meter of panel JSON, or \"unit\" in a garment file";
    return ", a garment's largest panel has 0.15 to 6 m";
}

void require_wearable_size(const Pattern& pattern)
{
    const auto largest =
        std::max_element(pattern.panels.begin(), pattern.panels.end(),
                         [](const Panel& a, const Panel& b) { return size_of(a) < size_of(b); });
    const double size = size_of(*largest);
    if (size >= kMinPanel && size <= kMaxPanel)
        return;
    throw InvalidInput(pattern.source + ": panel \"" + largest->name + "\": is the largest and " +
                       short_text(size) + " m long, " + (size < kMinPanel ? "less than a hand" : "a house") +
                       "; the unit is wrong" + likely_unit(size));
}

[[noreturn]] void refuse(const Pattern& pattern, const Seam& seam, const std::string& why)
{
    throw InvalidInput(pattern.source + ": " + seam.name + ": " + why);
}

/// Part of an edge that is in use, from lower to upper fraction.
struct Use {
    double lower;
    double upper;
    const Seam* seam;
};

using Uses = std::map<std::pair<int, int>, std::vector<Use>>; ///< by panel and edge

void add_use(const Pattern& pattern, const Seam& seam, const EdgePart& part, Uses& uses)
{
    const Use use{std::min(part.from, part.to), std::max(part.from, part.to), &seam};
    std::vector<Use>& others = uses[{part.panel, part.edge}];
    for (const Use& other : others)
        if (use.lower < other.upper - kOverlap && other.lower < use.upper - kOverlap)
            refuse(pattern, seam,
                   name_of(pattern, part) +
                       (other.seam == &seam ? " is in it twice" : " is in " + other.seam->name + " too") +
                       "; an edge is sewn once, or each part of it once");
    others.push_back(use);
}

/// Points of panels that are one point when sewn.
class SewnPoints {
public:
    explicit SewnPoints(const Pattern& pattern) : pattern_(pattern)
    {
        for (const Seam& seam : pattern.seams) {
            join(id(seam.a.front(), seam.a.front().from), id(seam.b.front(), seam.b.front().from));
            join(id(seam.a.back(), seam.a.back().to), id(seam.b.back(), seam.b.back().to));
        }
    }

    bool are_one(const EdgePart& before, const EdgePart& after)
    {
        return root(id(before, before.to)) == root(id(after, after.from));
    }

private:
    /// Number of a point at a fraction of an edge. Corners are shared by the edges that meet there.
    int id(const EdgePart& part, double fraction)
    {
        constexpr double kSteps = 1e6; // fractions closer than that are the same
        const Panel& panel = pattern_.panels[size_t(part.panel)];
        const long step = std::lround(fraction * kSteps);
        std::array<long, 3> key{part.panel, part.edge, step};
        if (line_of(panel, part.edge) == nullptr && (step == 0 || step == long(kSteps))) {
            const PanelEdge& edge = panel.edges[size_t(part.edge)];
            key = {part.panel, -1, step == 0 ? edge.start : edge.end};
        }
        const auto [entry, is_new] = ids_.try_emplace(key, int(parents_.size()));
        if (is_new)
            parents_.push_back(entry->second);
        return entry->second;
    }

    int root(int point)
    {
        while (parents_[size_t(point)] != point)
            point = parents_[size_t(point)] = parents_[size_t(parents_[size_t(point)])];
        return point;
    }

    void join(int a, int b) { parents_[size_t(root(a))] = root(b); }

    const Pattern& pattern_;
    std::map<std::array<long, 3>, int> ids_;
    std::vector<int> parents_;
};

void require_chain(const Pattern& pattern, const Seam& seam, const std::vector<EdgePart>& chain,
                   SewnPoints& points)
{
    for (size_t i = 1; i < chain.size(); ++i)
        if (!points.are_one(chain[i - 1], chain[i]))
            refuse(pattern, seam,
                   name_of(pattern, chain[i]) + " does not continue " + name_of(pattern, chain[i - 1]) +
                       "; list edges in their order along the seam, each from the end of the one before "
                       "(EDGE[1:0] runs backwards), or make two seams");
}

std::string label_of(const Pattern& pattern, const EdgePart& part)
{
    if (line_of(pattern.panels[size_t(part.panel)], part.edge))
        return "";
    return pattern.panels[size_t(part.panel)].edges[size_t(part.edge)].label;
}

void require_one_label(const Pattern& pattern, const Seam& seam)
{
    if (seam.a.size() != 1 || seam.b.size() != 1)
        return;
    const std::string a = label_of(pattern, seam.a[0]), b = label_of(pattern, seam.b[0]);
    if (!a.empty() && !b.empty() && a != b)
        refuse(pattern, seam,
               name_of(pattern, seam.a[0]) + " is labelled \"" + a + "\", but " +
                   name_of(pattern, seam.b[0]) + " \"" + b +
                   "\"; edges that are sewn become one, give them one label");
}

void require_gatherable(const Pattern& pattern, const Seam& seam)
{
    const double a = SeamSide(pattern, seam.a).length();
    const double b = SeamSide(pattern, seam.b).length();
    if (std::max(a, b) > kMaxRatio * std::min(a, b))
        refuse(pattern, seam,
               name_of(pattern, seam.a[0]) + " is " + short_text(a) + " m long, but " +
                   name_of(pattern, seam.b[0]) + " " + short_text(b) + " m; at most " +
                   short_text(kMaxRatio) +
                   " times as long can be gathered, sew other edges or parts of them");
}

} // namespace

std::string name_of(const Pattern& pattern, const EdgePart& part)
{
    const Panel& panel = pattern.panels[size_t(part.panel)];
    const PanelLine* line = line_of(panel, part.edge);
    std::string name = panel.name + (line ? " line " + line->name : " edge " + std::to_string(part.edge));
    if (std::min(part.from, part.to) > 0.0 || std::max(part.from, part.to) < 1.0)
        name.append("[").append(short_text(part.from)).append(":").append(short_text(part.to)).append("]");
    return name;
}

void require_sewable(const Pattern& pattern)
{
    if (pattern.panels.empty())
        throw InvalidInput(pattern.source + ": has no panel; a garment needs one at least");
    for (const Panel& panel : pattern.panels)
        require_cuttable(panel, pattern.source);
    require_wearable_size(pattern);

    Uses uses;
    for (const Seam& seam : pattern.seams)
        for (const std::vector<EdgePart>* side : {&seam.a, &seam.b})
            for (const EdgePart& part : *side)
                add_use(pattern, seam, part, uses);
    SewnPoints points(pattern);
    for (const Seam& seam : pattern.seams) {
        require_chain(pattern, seam, seam.a, points);
        require_chain(pattern, seam, seam.b, points);
        require_one_label(pattern, seam);
        require_gatherable(pattern, seam);
    }
}

} // namespace toile::garment
