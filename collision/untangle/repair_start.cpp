#include "collision/untangle/repair_start.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include <Eigen/Geometry>

#include "collision/crossings/find_crossings.h"
#include "collision/untangle/layers.h"
#include "collision/untangle/untangle_cloth.h"

namespace toile {

namespace {

/// Depth [m] from which on a point counts as inside a body: below, it touches.
constexpr double kTouch = 1e-6;

/// Growing bodies and untangling may undo a little of each other.
constexpr int kMaxRounds = 4;

/// Distance [m] that one of two crossing triangles has to move along the other's normal to be clear of it.
double depth_of(View<const Vec3> x, const Triangle& a, const Triangle& b)
{
    const auto past = [&](const Triangle& moved, const Triangle& still) {
        const Vec3 normal = (x[still[1]] - x[still[0]]).cross(x[still[2]] - x[still[0]]).normalized();
        double above = 0.0, below = 0.0;
        for (const int v : moved) {
            const double height = normal.dot(x[v] - x[still[0]]);
            above = std::max(above, height);
            below = std::max(below, -height);
        }
        return std::min(above, below);
    };
    return std::min(past(a, b), past(b, a));
}

/// Everything wrong at x, by what it consists of.
class Faults {
public:
    using Key = std::tuple<StartPlace::Kind, int, std::array<int, 3>, std::array<int, 3>>;

    Faults(const JoinedCloths& cloths, const BodyClearing& clearing, View<const Vec3> x)
    {
        for (const InsideSample& sample : clearing.inside(x, kTouch)) {
            StartPlace place = place_of(cloths, sample.vertex);
            place.position = sample.point;
            place.depth = -sample.place.signed_distance;
            place.other = sample.place.body;
            add({StartPlace::Kind::InsideBody, sample.place.body, sample.vertex, {}}, place);
        }
        for (const Crossing& crossing : find_crossings(cloths.triangles, x)) {
            const Triangle &a = cloths.triangles[crossing.a], &b = cloths.triangles[crossing.b];
            StartPlace place = place_of(cloths, {a[0], a[1], a[2]});
            place.kind = StartPlace::Kind::Crossing;
            place.position = crossing.point;
            place.depth = depth_of(x, a, b);
            place.other = cloths.cloth[b[0]];
            place.is_held = place.is_held && place_of(cloths, {b[0], b[1], b[2]}).is_held;
            add({place.kind, 0, {a[0], a[1], a[2]}, {b[0], b[1], b[2]}}, place);
            ++crossing_count;
        }
    }

    std::vector<std::pair<Key, StartPlace>> places;
    int crossing_count = 0;

    bool can_be_repaired() const
    {
        return std::any_of(places.begin(), places.end(),
                           [](const auto& entry) { return !entry.second.is_held; });
    }

private:
    static StartPlace place_of(const JoinedCloths& cloths, const std::array<int, 3>& vertex)
    {
        StartPlace place;
        place.cloth = cloths.cloth[vertex[0]];
        place.is_held = true;
        for (int k = 0; k < 3 && vertex[k] >= 0; ++k) {
            place.vertex[k] = vertex[k] - cloths.first_vertex[place.cloth];
            place.is_held = place.is_held && cloths.fixed[vertex[k]] != 0;
        }
        return place;
    }

    void add(const Key& key, const StartPlace& place) { places.emplace_back(key, place); }
};

/// Marks what is gone, appends what is new.
void compare(const Faults& before, const Faults& after, StartReport& report)
{
    std::set<Faults::Key> left, known;
    for (const auto& [key, place] : after.places)
        left.insert(key);
    report.places.clear();
    for (const auto& [key, place] : before.places) {
        known.insert(key);
        report.places.push_back(place);
        report.places.back().is_repaired = left.count(key) == 0;
    }
    for (const auto& [key, place] : after.places)
        if (known.count(key) == 0)
            report.places.push_back(place);
}

/// One round of all steps.
void repair_once(const JoinedCloths& cloths, const std::vector<ContactPartner>& bodies,
                 const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x)
{
    clearing.grow(x, keeper);
    separate_layers(cloths, bodies, x);
    if (untangle(cloths, clearing, keeper, x))
        relax_untangled(cloths, clearing, keeper, x);
}

} // namespace

StartReport check_start(const std::vector<StartCloth>& cloths, const std::vector<ContactPartner>& bodies)
{
    const JoinedCloths joined(cloths);
    StartReport report;
    for (const auto& [key, place] : Faults(joined, BodyClearing(joined, bodies), joined.start).places)
        report.places.push_back(place);
    return report;
}

StartReport repair_start(std::vector<StartCloth>& cloths, const std::vector<ContactPartner>& bodies)
{
    JoinedCloths joined(cloths);
    const BodyClearing clearing(joined, bodies);
    std::optional<ShapeKeeper> keeper(joined);
    const Faults before(joined, clearing, joined.start);
    Faults best = before;
    std::vector<Vec3> x = joined.start, best_x = x;
    StartReport report;
    report.was_repaired = true;
    while (report.rounds < kMaxRounds && best.can_be_repaired()) {
        repair_once(joined, bodies, clearing, *keeper, x);
        ++report.rounds;
        Faults now(joined, clearing, x);
        const bool is_tangled = now.crossing_count > 0;
        if (std::pair(now.crossing_count, now.places.size()) <
            std::pair(best.crossing_count, best.places.size())) {
            best = std::move(now);
            best_x = x;
        }
        if (is_tangled && report.rounds == 1) {
            // Contours that only layers resolve: once more from the start, with an order of all pieces.
            joined.layer = layers_without_ties(joined, bodies);
            x = joined.start;
            keeper.emplace(joined);
        }
    }

    compare(before, best, report);
    const EdgeStrain strain = edge_strain(joined, best_x);
    report.max_strain = strain.max;
    report.rms_strain = strain.rms;
    for (int v = 0; v < joined.vertex_count(); ++v)
        report.max_move = std::max(report.max_move, (best_x[v] - joined.start[v]).norm());
    for (size_t c = 0; c < cloths.size(); ++c)
        cloths[c].positions.assign(best_x.begin() + joined.first_vertex[c],
                                   best_x.begin() + joined.first_vertex[c + 1]);
    return report;
}

} // namespace toile
