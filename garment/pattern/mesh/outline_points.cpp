#include "garment/pattern/mesh/outline_points.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"

namespace toile::garment {

namespace {

/// One side of a seam over its arc length.
struct Side {
    const std::vector<EdgePart>* parts = nullptr;
    std::vector<double> starts; ///< [parts + 1] arc length at which each part starts [m]
    std::vector<double> marks;  ///< arc lengths inside parts at which there must be a point [m]

    double length() const { return starts.back(); }
};

/// A point of a seam: the fraction of arc length on each side. [-]
using Break = std::array<double, 2>;

/// Stretch of an edge between two breaks of a seam, or of none.
struct Stretch {
    double from = 0.0, to = 0.0; ///< [-] fractions of the edge, in the direction of the seam
    int count = 1;               ///< intervals between its points
    int seam = -1, interval = 0, side = 0;

    double low() const { return std::min(from, to); }
    double high() const { return std::max(from, to); }
};

using Stretches = std::vector<std::vector<std::vector<Stretch>>>; // [panels][edges]

int intervals(double length, double target)
{
    // A length that is a multiple of the target up to rounding is not divided once more.
    constexpr double kRounding = 1e-3;
    return std::max(1, int(std::ceil(length / target - kRounding)));
}

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

void require_part(const Pattern& pattern, const Seam& seam, const EdgePart& part)
{
    const std::string place = pattern.source + ": seam " + quoted(seam.name);
    if (part.panel < 0 || part.panel >= int(pattern.panels.size()))
        throw InvalidInput(place + ": panel " + std::to_string(part.panel) +
                           " does not exist; the pattern has " + std::to_string(pattern.panels.size()));
    const Panel& panel = pattern.panels[part.panel];
    if (part.edge < 0 || part.edge >= int(panel.edges.size() + panel.lines.size()))
        throw InvalidInput(place + ": panel " + quoted(panel.name) + " has no edge " +
                           std::to_string(part.edge) + "; it has " + std::to_string(panel.edges.size()));
    const bool inside = std::min(part.from, part.to) >= 0.0 && std::max(part.from, part.to) <= 1.0;
    if (!inside || !(std::abs(part.to - part.from) > kSameFraction))
        throw InvalidInput(place + ": panel " + quoted(panel.name) + ", edge " + std::to_string(part.edge) +
                           " from " + std::to_string(part.from) + " to " + std::to_string(part.to) +
                           "; fractions lie between 0 and 1, more than " + std::to_string(kSameFraction) +
                           " apart");
}

Side side_of(const Pattern& pattern, const PatternCurves& curves, const Seam& seam,
             const std::vector<EdgePart>& parts, const OutlineTargets& targets)
{
    if (parts.empty())
        throw InvalidInput(pattern.source + ": seam " + quoted(seam.name) +
                           " has no edge on one side; name one");
    Side side{&parts, {0.0}, {}};
    for (const EdgePart& part : parts) {
        require_part(pattern, seam, part);
        const double length = curves[part.panel][part.edge].length(), start = side.starts.back();
        for (const double mark : targets.marks[part.panel][part.edge])
            if (mark > std::min(part.from, part.to) + kSameFraction &&
                mark < std::max(part.from, part.to) - kSameFraction)
                side.marks.push_back(start + length * std::abs(mark - part.from));
        side.starts.push_back(start + length * std::abs(part.to - part.from));
    }
    return side;
}

/// Fractions of a side's length at which one part ends and the next starts, or a mark is.
std::vector<double> junctions(const Side& side)
{
    std::vector<double> result;
    for (size_t i = 1; i + 1 < side.starts.size(); ++i)
        result.push_back(side.starts[i] / side.length());
    for (const double mark : side.marks)
        result.push_back(mark / side.length());
    std::sort(result.begin(), result.end());
    return result;
}

/// Pairs of junctions of both sides that meet, with the seam's ends.
std::vector<Break> meeting_junctions(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<Break> result{{0.0, 0.0}};
    size_t next = 0;
    for (const double s : a) {
        while (next < b.size() && b[next] < s - kSameCorner)
            ++next;
        if (next < b.size() && b[next] <= s + kSameCorner)
            result.push_back({s, b[next++]});
    }
    result.push_back({1.0, 1.0});
    return result;
}

/// Point of the other side that meets `s` on `side`: fractions count between the meeting junctions.
double opposite_of(const std::vector<Break>& meeting, int side, double s)
{
    size_t k = 1;
    while (k + 1 < meeting.size() && meeting[k][side] < s)
        ++k;
    const Break &low = meeting[k - 1], &high = meeting[k];
    const double t = (s - low[side]) / (high[side] - low[side]);
    return low[1 - side] + t * (high[1 - side] - low[1 - side]);
}

std::vector<Break> breaks_of(const Side& a, const Side& b)
{
    const std::array<std::vector<double>, 2> own{junctions(a), junctions(b)};
    const std::vector<Break> meeting = meeting_junctions(own[0], own[1]);
    std::vector<Break> breaks = meeting;
    for (int side = 0; side < 2; ++side)
        for (const double s : own[side]) {
            const auto is_met = [&](const Break& other) { return other[side] == s; };
            if (std::any_of(meeting.begin(), meeting.end(), is_met))
                continue;
            Break alone;
            alone[side] = s;
            alone[1 - side] = opposite_of(meeting, side, s);
            breaks.push_back(alone);
        }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

/// Stretch of a side between two of its fractions, which lie in one part.
struct Piece {
    int panel = 0, edge = 0;
    double from = 0.0, to = 0.0; ///< [-] of the edge
    double length = 0.0;         ///< [m]
};

Piece piece_of(const Side& side, double low, double high)
{
    const double middle = 0.5 * (low + high) * side.length();
    const size_t k =
        std::upper_bound(side.starts.begin() + 1, side.starts.end() - 1, middle) - side.starts.begin() - 1;
    const EdgePart& part = (*side.parts)[k];
    const double start = side.starts[k], end = side.starts[k + 1];
    // Ends of parts are exact, so that those that meet on an edge are one point.
    const auto fraction = [&](double s) {
        if (s == start / side.length())
            return part.from;
        return s == end / side.length()
                   ? part.to
                   : part.from + (part.to - part.from) * (s * side.length() - start) / (end - start);
    };
    return {part.panel, part.edge, fraction(low), fraction(high), (high - low) * side.length()};
}

/// Divides a seam into stretches of both sides, with equally many intervals. Returns their number.
int add_seam(const std::array<Side, 2>& sides, const std::vector<double>& targets, int seam,
             Stretches& stretches)
{
    const std::vector<Break> breaks = breaks_of(sides[0], sides[1]);
    for (size_t k = 0; k + 1 < breaks.size(); ++k) {
        std::array<Piece, 2> pieces;
        int count = 1;
        for (int s = 0; s < 2; ++s) {
            pieces[s] = piece_of(sides[s], breaks[k][s], breaks[k + 1][s]);
            count = std::max(count, intervals(pieces[s].length, targets[pieces[s].panel]));
        }
        for (int s = 0; s < 2; ++s)
            stretches[pieces[s].panel][pieces[s].edge].push_back(
                {pieces[s].from, pieces[s].to, count, seam, int(k), s});
    }
    return int(breaks.size()) - 1;
}

[[noreturn]] void refuse_overlap(const Pattern& pattern, int panel, int edge, const Stretch& a,
                                 const Stretch& b)
{
    const auto range = [](const Stretch& s) {
        return std::to_string(s.low()) + " to " + std::to_string(s.high());
    };
    throw InvalidInput(pattern.source + ": panel " + quoted(pattern.panels[panel].name) + ", edge " +
                       std::to_string(edge) + " is sewn twice: by seam " +
                       quoted(pattern.seams[a.seam].name) + " from " + range(a) + " and by seam " +
                       quoted(pattern.seams[b.seam].name) + " from " + range(b) +
                       "; parts on one edge may not overlap");
}

/// Sorts the sewn stretches of an edge and puts free ones into the gaps, so that they cover it.
std::vector<Stretch> cover_edge(const Pattern& pattern, int panel, int edge, std::vector<Stretch> sewn,
                                double length, const OutlineTargets& targets)
{
    std::sort(sewn.begin(), sewn.end(), [](const Stretch& a, const Stretch& b) { return a.low() < b.low(); });
    std::vector<Stretch> result;
    double covered = 0.0;
    const auto cover_freely = [&](double fraction) {
        if (fraction - covered > kSameFraction)
            result.push_back({covered, fraction,
                              std::max(targets.free_intervals[panel][edge],
                                       intervals((fraction - covered) * length, targets.edge[panel]))});
    };
    const auto cover_until = [&](double fraction) {
        for (const double mark : targets.marks[panel][edge])
            if (mark > covered + kSameFraction && mark < fraction - kSameFraction) {
                cover_freely(mark);
                covered = mark;
            }
        cover_freely(fraction);
    };
    for (Stretch& stretch : sewn) {
        if (stretch.low() < covered - kSameFraction)
            refuse_overlap(pattern, panel, edge, result.back(), stretch);
        cover_until(stretch.low());
        if (std::abs(stretch.low() - covered) <= kSameFraction)
            (stretch.from < stretch.to ? stretch.from : stretch.to) = covered;
        if (stretch.high() >= 1.0 - kSameFraction)
            (stretch.from < stretch.to ? stretch.to : stretch.from) = 1.0;
        covered = stretch.high();
        result.push_back(stretch);
    }
    cover_until(1.0);
    return result;
}

/// First point of each seam's stretch on its edge, and whether it runs against it.
struct Run {
    OutlinePoint first;
    int count = 1;
    bool is_reversed = false;

    OutlinePoint point(int i) const
    {
        return {first.panel, first.edge, first.point + (is_reversed ? count - i : i)};
    }
};

using SeamRuns = std::vector<std::vector<std::array<Run, 2>>>; // [seams][intervals][sides]

/// Points of an edge that its stretches divide. Notes where those of seams lie.
std::vector<double> place_points(int panel, int edge, const std::vector<Stretch>& stretches, SeamRuns& runs)
{
    std::vector<double> fractions{0.0};
    for (const Stretch& stretch : stretches) {
        const int first = int(fractions.size()) - 1;
        const double low = stretch.low(), high = stretch.high();
        for (int i = 1; i <= stretch.count; ++i)
            fractions.push_back(i == stretch.count ? high : low + (high - low) * i / stretch.count);
        if (stretch.seam >= 0)
            runs[stretch.seam][stretch.interval][stretch.side] = {
                {panel, edge, first}, stretch.count, stretch.from > stretch.to};
    }
    return fractions;
}

std::vector<std::array<OutlinePoint, 2>> pairs_along(const std::vector<std::array<Run, 2>>& runs)
{
    std::vector<std::array<OutlinePoint, 2>> pairs;
    for (const auto& [a, b] : runs)
        for (int i = 0; i <= a.count; ++i)
            pairs.push_back({a.point(i), b.point(i)});
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace

PatternCurves with_lines(const Pattern& pattern, PatternCurves curves)
{
    for (size_t p = 0; p < curves.size(); ++p)
        for (size_t l = 0; l < pattern.panels[p].lines.size(); ++l)
            curves[p].emplace_back(pattern.panels[p], int(pattern.panels[p].edges.size() + l));
    return curves;
}

OutlinePoints divide_outlines(const Pattern& pattern, const PatternCurves& curves,
                              const OutlineTargets& targets)
{
    Stretches stretches;
    for (const auto& panel : curves)
        stretches.emplace_back(panel.size());

    SeamRuns runs;
    for (size_t s = 0; s < pattern.seams.size(); ++s) {
        const Seam& seam = pattern.seams[s];
        const std::array sides{side_of(pattern, curves, seam, seam.a, targets),
                               side_of(pattern, curves, seam, seam.b, targets)};
        runs.emplace_back(add_seam(sides, targets.edge, int(s), stretches));
    }

    OutlinePoints points;
    for (size_t p = 0; p < curves.size(); ++p) {
        points.fractions.emplace_back();
        points.line_fractions.emplace_back();
        for (size_t e = 0; e < curves[p].size(); ++e)
            (e < pattern.panels[p].edges.size() ? points.fractions : points.line_fractions)[p].push_back(
                place_points(int(p), int(e),
                             cover_edge(pattern, int(p), int(e), std::move(stretches[p][e]),
                                        curves[p][e].length(), targets),
                             runs));
    }
    for (const auto& seam : runs)
        points.seams.push_back(pairs_along(seam));
    return points;
}

} // namespace toile::garment
