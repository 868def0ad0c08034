#include "collision/repair/repair_start.h"

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include <Eigen/Geometry>

#include "collision/check/find_crossings.h"
#include "collision/repair/layers.h"
#include "collision/repair/untangle_cloth.h"
#include "core/base/cancellation.h"

namespace toile::collision {

namespace {

/// Part of the gap to a body [-] below which contact would throw cloth off.
constexpr double kNear = 0.75;

/// Maximum number of passes: growing bodies and untangling may partly undo each other.
constexpr int kMaxPasses = 4;

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

/// Defects of a pose x, keyed by the primitives involved.
class Faults {
public:
    using Key = std::tuple<StartDefect::Kind, int, std::array<int, 3>, std::array<int, 3>>;

    Faults(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies,
           const BodyClearing& clearing, View<const Vec3> x)
    {
        Cancellation::check();
        for (const InsideSample& sample : clearing.inside(x, kTouchDepth)) {
            StartDefect defect = defect_of(cloths, sample.vertex);
            defect.position = sample.point;
            defect.depth = -sample.proximity.signed_distance;
            defect.other = sample.proximity.body;
            add({StartDefect::Kind::InsideBody, sample.proximity.body, sample.vertex, {}}, defect);
        }
        Cancellation::check();
        std::set<std::pair<int, int>> known; // a triangle crosses many of a body's
        for (const SurfaceCrossing& crossing : clearing.crossings(x)) {
            const Triangle& t = cloths.triangles[crossing.triangle];
            StartDefect defect = defect_of(cloths, {t[0], t[1], t[2]});
            defect.kind = StartDefect::Kind::CrossesBody;
            defect.position = crossing.point;
            defect.depth = crossing.way_out.norm();
            defect.other = crossing.body;
            if (known.emplace(crossing.triangle, crossing.body).second)
                add({defect.kind, crossing.body, {t[0], t[1], t[2]}, {}}, defect);
        }
        Cancellation::check();
        for (const UnderLayer& under : find_under_layers(cloths, bodies, x)) {
            StartDefect defect = defect_of(cloths, {under.vertex, -1, -1});
            defect.kind = StartDefect::Kind::UnderLayer;
            defect.position = x[under.vertex];
            defect.depth = under.depth;
            defect.other = cloths.cloth[under.lower];
            add({defect.kind, defect.cloth, {}, {}}, defect);
        }
        Cancellation::check();
        for (const Crossing& crossing : find_crossings(cloths.triangles, x)) {
            const Triangle &a = cloths.triangles[crossing.a], &b = cloths.triangles[crossing.b];
            StartDefect defect = defect_of(cloths, {a[0], a[1], a[2]});
            defect.kind = StartDefect::Kind::Crossing;
            defect.position = crossing.point;
            defect.depth = depth_of(x, a, b);
            defect.other = cloths.cloth[b[0]];
            defect.is_fixed = defect.is_fixed && defect_of(cloths, {b[0], b[1], b[2]}).is_fixed;
            add({defect.kind, 0, {a[0], a[1], a[2]}, {b[0], b[1], b[2]}}, defect);
            ++crossing_count;
        }
    }

    std::vector<std::pair<Key, StartDefect>> defects;
    int crossing_count = 0;

    bool can_be_repaired() const
    {
        return std::any_of(defects.begin(), defects.end(),
                           [](const auto& entry) { return !entry.second.is_fixed; });
    }

private:
    static StartDefect defect_of(const JoinedCloths& cloths, const std::array<int, 3>& vertex)
    {
        StartDefect defect;
        defect.cloth = cloths.cloth[vertex[0]];
        defect.is_fixed = true;
        for (int k = 0; k < 3 && vertex[k] >= 0; ++k) {
            defect.vertex[k] = vertex[k] - cloths.first_vertex[defect.cloth];
            defect.is_fixed = defect.is_fixed && cloths.fixed[vertex[k]] != 0;
        }
        return defect;
    }

    void add(const Key& key, const StartDefect& defect) { defects.emplace_back(key, defect); }
};

/// Marks repaired defects and appends new ones.
void compare(const Faults& before, const Faults& after, StartReport& report)
{
    std::set<Faults::Key> left, known;
    for (const auto& [key, defect] : after.defects)
        left.insert(key);
    report.defects.clear();
    for (const auto& [key, defect] : before.defects) {
        known.insert(key);
        report.defects.push_back(defect);
        report.defects.back().is_repaired = left.count(key) == 0;
    }
    for (const auto& [key, defect] : after.defects)
        if (known.count(key) == 0)
            report.defects.push_back(defect);
}

/// Runs one pass of all repair steps.
void repair_once(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies,
                 const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x,
                 const RepairProgress& progress)
{
    clearing.grow(x, keeper, progress.part(0.0, 0.3));
    separate_layers(cloths, bodies, x, progress.part(0.3, 0.4));
    progress.update(0.4);
    if (untangle(cloths, clearing, keeper, x))
        relax_untangled(cloths, clearing, keeper, x, progress.part(0.5, 0.9));
    clear_crossings(cloths, clearing, x);
}

/// Value that a fraction of the items does not exceed.
double quantile(std::vector<double>& items, double fraction)
{
    if (items.empty())
        return 0.0;
    const auto at = items.begin() + std::ptrdiff_t(fraction * double(items.size() - 1));
    std::nth_element(items.begin(), at, items.end());
    return *at;
}

/// What has changed from the start to x, cloth by cloth.
std::vector<StartReport::Change> changes_of(const JoinedCloths& cloths, View<const Vec3> x)
{
    std::vector<StartReport::Change> changes(cloths.first_vertex.size() - 1);
    for (int v = 0; v < cloths.vertex_count(); ++v) {
        StartReport::Change& change = changes[cloths.cloth[v]];
        const double move = (x[v] - cloths.start[v]).norm();
        if (move > change.max_move) {
            change.max_move = move;
            change.vertex = v - cloths.first_vertex[cloths.cloth[v]];
        }
    }
    std::vector<std::vector<double>> strains(changes.size());
    for (int e = 0; e < cloths.edges.edge_count(); ++e) {
        const auto [a, b] = cloths.edges.vertex[e];
        strains[cloths.cloth[a]].push_back(std::abs((x[a] - x[b]).norm() / cloths.length[e] - 1.0));
    }
    for (size_t c = 0; c < changes.size(); ++c)
        changes[c].strain_p99 = quantile(strains[c], 0.99);
    return changes;
}

/// See find_too_near().
std::vector<std::vector<int>> too_near(const JoinedCloths& cloths, const BodyClearing& clearing,
                                       View<const Vec3> x)
{
    std::vector<std::vector<int>> near(cloths.first_vertex.size() - 1);
    for (const int v : clearing.nearer(x, kNear))
        near[cloths.cloth[v]].push_back(v - cloths.first_vertex[cloths.cloth[v]]);
    return near;
}

} // namespace

StartReport check_start(const std::vector<StartCloth>& cloths, const std::vector<ContactCollider>& bodies)
{
    const JoinedCloths joined(cloths);
    const BodyClearing clearing(joined, bodies);
    StartReport report;
    report.edge_count = joined.edges.edge_count();
    report.changes.resize(cloths.size());
    report.too_near = too_near(joined, clearing, joined.start);
    for (const auto& [key, defect] : Faults(joined, bodies, clearing, joined.start).defects)
        report.defects.push_back(defect);
    return report;
}

std::vector<std::vector<int>> find_too_near(const std::vector<StartCloth>& cloths,
                                            const std::vector<ContactCollider>& bodies)
{
    const JoinedCloths joined(cloths);
    return too_near(joined, BodyClearing(joined, bodies), joined.start);
}

StartReport repair_start(std::vector<StartCloth>& cloths, const std::vector<ContactCollider>& bodies,
                         const RepairProgress& progress)
{
    JoinedCloths joined(cloths);
    const BodyClearing clearing(joined, bodies);
    std::optional<ShapeKeeper> keeper(joined);
    const Faults before(joined, bodies, clearing, joined.start);
    Faults best = before;
    std::vector<Vec3> x = joined.start, best_x = x;
    StartReport report;
    report.was_repaired = true;
    while (report.passes < kMaxPasses && best.can_be_repaired()) {
        const double pass = report.passes++;
        repair_once(joined, bodies, clearing, *keeper, x,
                    progress.part(pass / kMaxPasses, (pass + 1.0) / kMaxPasses));
        Faults now(joined, bodies, clearing, x);
        const bool is_tangled = now.crossing_count > 0;
        if (std::pair(now.crossing_count, now.defects.size()) <
            std::pair(best.crossing_count, best.defects.size())) {
            best = std::move(now);
            best_x = x;
        }
        if (is_tangled && report.passes == 1) {
            // Only layers resolve these contours: restart with a total order of the pieces.
            joined.layer = layers_without_ties(joined, bodies);
            x = joined.start;
            keeper.emplace(joined);
        }
    }

    progress.update(1.0);
    compare(before, best, report);
    report.changes = changes_of(joined, best_x);
    report.too_near = too_near(joined, clearing, best_x);
    const EdgeStrain strain = edge_strain(joined, best_x);
    report.max_strain = strain.max;
    report.rms_strain = strain.rms;
    report.edge_count = joined.edges.edge_count();
    for (const StartReport::Change& change : report.changes)
        report.max_move = std::max(report.max_move, change.max_move);
    for (size_t c = 0; c < cloths.size(); ++c)
        cloths[c].positions.assign(best_x.begin() + joined.first_vertex[c],
                                   best_x.begin() + joined.first_vertex[c + 1]);
    return report;
}

} // namespace toile::collision
