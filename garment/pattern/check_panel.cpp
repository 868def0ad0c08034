#include "garment/pattern/check_panel.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/number.h"
#include "garment/pattern/edge_curve.h"

namespace toile::garment {
namespace {

/// [m] Shorter edges are mistakes: no stitch is as short.
constexpr double kMinEdge = 1e-4;

/// [m] Parts of a loop that come closer touch.
constexpr double kTouching = 1e-6;

/// [-] Area over squared perimeter of the thinnest panel: 1 m long and 0.4 mm wide.
constexpr double kMinAreaRatio = 1e-4;

/// More edges are a polyline where a curve is meant; the search for crossings would take minutes.
constexpr int kMaxEdges = 1000;

/// Chords of a curved edge in the search for crossings. With 64, a half circle of 1 m is off by 0.3 mm.
constexpr int kChords = 64;

/// Complaints about one panel.
class PanelErrors {
public:
    PanelErrors(const Panel& panel, const std::string& source) : panel_(panel), source_(source) {}

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InvalidInput(source_ + ": panel \"" + panel_.name + "\": " + why);
    }
    [[noreturn]] void refuse(int edge, const std::string& why) const
    {
        throw InvalidInput(source_ + ": panel \"" + panel_.name + "\", edge " + std::to_string(edge) + ": " +
                           why);
    }

private:
    const Panel& panel_;
    const std::string& source_;
};

void require_loop(const Panel& panel, const PanelErrors& errors)
{
    const auto count = int(panel.edges.size());
    if (count < 2)
        errors.refuse("has " + std::to_string(count) + (count == 1 ? " edge" : " edges") +
                      "; a loop needs three, or two of which one is curved");
    if (count > kMaxEdges)
        errors.refuse("has " + std::to_string(count) + " edges, at most " + std::to_string(kMaxEdges) +
                      " may be; write curves in place of short lines");
    std::vector<int> visits(panel.corners.size(), 0);
    for (int i = 0; i < count; ++i) {
        const PanelEdge& edge = panel.edges[size_t(i)];
        const int next = (i + 1) % count;
        if (edge.end != panel.edges[size_t(next)].start)
            errors.refuse(i, "ends at vertex " + std::to_string(edge.end) + ", but edge " +
                                 std::to_string(next) + " starts at vertex " +
                                 std::to_string(panel.edges[size_t(next)].start) +
                                 "; the edges of a panel must form one closed loop");
        if (++visits[size_t(edge.start)] > 1)
            errors.refuse(i, "starts at vertex " + std::to_string(edge.start) +
                                 ", where the loop was before; cut the panel in two there");
    }
    if (const auto unused = std::find(visits.begin(), visits.end(), 0); unused != visits.end())
        errors.refuse("its vertex " + std::to_string(unused - visits.begin()) + " is on no edge; remove it");
}

/// Complains about edges without length and arcs without room, before they become curves.
void require_edge(const Panel& panel, int index, const PanelErrors& errors)
{
    const PanelEdge& edge = panel.edges[size_t(index)];
    const double chord = (panel.corners[size_t(edge.end)] - panel.corners[size_t(edge.start)]).norm();
    if (!(chord >= kMinEdge))
        errors.refuse(index, "its ends are " + short_text(chord) +
                                 " m apart; leave it out, or move a vertex by 0.1 mm at least");
    const auto* arc = std::get_if<CircularArc>(&edge.curve);
    if (arc != nullptr && !(arc->radius >= 0.5 * chord * (1.0 - 1e-6)))
        errors.refuse(index, "an arc of radius " + short_text(arc->radius) + " m cannot join ends that are " +
                                 short_text(chord) + " m apart; use at least half that distance");
}

/// Straight piece of a loop.
struct Chord {
    Vec2 from;
    Vec2 to;
    int edge;
};

std::vector<Chord> chords_of(const Panel& panel)
{
    std::vector<Chord> chords;
    for (int e = 0; e < int(panel.edges.size()); ++e) {
        const EdgeCurve curve(panel, e);
        const int count = is_straight(panel.edges[size_t(e)]) ? 1 : kChords;
        for (int i = 0; i < count; ++i)
            chords.push_back({curve.at(double(i) / count), curve.at(double(i + 1) / count), e});
    }
    return chords;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to(const Chord& chord, const Vec2& point)
{
    const Vec2 along = chord.to - chord.from;
    const double t = std::clamp((point - chord.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (point - chord.from - t * along).norm();
}

bool boxes_meet(const Chord& a, const Chord& b)
{
    const Vec2 margin = Vec2::Constant(kTouching);
    return (a.from.cwiseMin(a.to) - margin - b.from.cwiseMax(b.to)).maxCoeff() <= 0.0 &&
           (b.from.cwiseMin(b.to) - margin - a.from.cwiseMax(a.to)).maxCoeff() <= 0.0;
}

bool meet(const Chord& a, const Chord& b)
{
    if (!boxes_meet(a, b))
        return false;
    const Vec2 along_a = a.to - a.from;
    const Vec2 along_b = b.to - b.from;
    const bool b_straddles = cross(along_a, b.from - a.from) * cross(along_a, b.to - a.from) < 0.0;
    const bool a_straddles = cross(along_b, a.from - b.from) * cross(along_b, a.to - b.from) < 0.0;
    return (a_straddles && b_straddles) || distance_to(a, b.from) < kTouching ||
           distance_to(a, b.to) < kTouching || distance_to(b, a.from) < kTouching ||
           distance_to(b, a.to) < kTouching;
}

/// Whether a chord runs back along the one before it.
bool folds_back(const Chord& a, const Chord& next)
{
    const Vec2 along = a.to - a.from;
    const Vec2 then = next.to - next.from;
    return along.dot(then) < 0.0 &&
           std::abs(cross(along, then)) < kTouching * std::max(along.norm(), then.norm());
}

void refuse_crossing(const Chord& a, const Chord& b, const PanelErrors& errors)
{
    const Vec2 place = 0.5 * (a.from + a.to);
    const std::string where = " near (" + short_text(place.x()) + ", " + short_text(place.y()) +
                              ") m; move vertices or control points apart";
    errors.refuse(a.edge, a.edge == b.edge ? "crosses itself" + where
                                           : "crosses or touches edge " + std::to_string(b.edge) + where);
}

void require_simple(const std::vector<Chord>& chords, const PanelErrors& errors)
{
    const size_t count = chords.size();
    for (size_t i = 0; i < count; ++i) {
        if (folds_back(chords[i], chords[(i + 1) % count]))
            refuse_crossing(chords[i], chords[(i + 1) % count], errors);
        // Neighbours share an end.
        const size_t end = i == 0 ? count - 1 : count;
        for (size_t j = i + 2; j < end; ++j)
            if (meet(chords[i], chords[j]))
                refuse_crossing(chords[i], chords[j], errors);
    }
}

} // namespace

void require_cuttable(const Panel& panel, const std::string& source)
{
    const PanelErrors errors(panel, source);
    require_loop(panel, errors);
    double perimeter = 0.0;
    for (int e = 0; e < int(panel.edges.size()); ++e) {
        require_edge(panel, e, errors);
        perimeter += EdgeCurve(panel, e).length();
    }
    require_simple(chords_of(panel), errors);
    const double area = std::abs(signed_area(panel));
    if (!(area > kMinAreaRatio * perimeter * perimeter))
        errors.refuse("has an area of " + short_text(area) + " m^2 in a loop of " + short_text(perimeter) +
                      " m; it is too thin to cut out");
}

} // namespace toile::garment
