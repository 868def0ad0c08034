#include "collision/repair/shape_keeper.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancellation.h"

namespace toile::collision {

namespace {

/// Fraction of a bend's error that one sweep removes [-]. Edges remove all of theirs: cloth bends before it
/// stretches.
constexpr double kBendStiffness = 0.2;

/// Distance [m] of the corners opposite to an edge once its two triangles lie in one plane.
double flat_distance(const JoinedCloths& cloths, int edge)
{
    const Vec3& a = cloths.start[cloths.edges.vertex[edge][0]];
    const Vec3 along = (cloths.start[cloths.edges.vertex[edge][1]] - a).normalized();
    const Vec3 p = cloths.start[cloths.opposite[edge][0]] - a, q = cloths.start[cloths.opposite[edge][1]] - a;
    const double heights = (p - along.dot(p) * along).norm() + (q - along.dot(q) * along).norm();
    return std::hypot(along.dot(p - q), heights);
}

} // namespace

ShapeKeeper::ShapeKeeper(const JoinedCloths& cloths) : cloths_(cloths)
{
    for (int e = 0; e < cloths.edges.edge_count(); ++e) {
        lengths_.push_back({cloths.edges.vertex[e], cloths.length[e], 1.0});
        const std::array<int, 2>& across = cloths.opposite[e];
        if (across[0] < 0 || across[0] == across[1])
            continue;
        const double bent = (cloths.start[across[0]] - cloths.start[across[1]]).norm();
        bends_.push_back({across, bent, kBendStiffness});
        flat_.push_back(flat_distance(cloths, e));
    }
}

void ShapeKeeper::relax(View<Vec3> x, int sweeps) const
{
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        Cancellation::check();
        for (const Distance& bend : bends_)
            project(bend, x);
        for (const Distance& length : lengths_)
            project(length, x);
    }
}

void ShapeKeeper::project(const Distance& distance, View<Vec3> x) const
{
    const auto [a, b] = distance.vertex;
    const double wa = cloths_.fixed[a] != 0 ? 0.0 : 1.0, wb = cloths_.fixed[b] != 0 ? 0.0 : 1.0;
    const Vec3 between = x[b] - x[a];
    const double length = between.norm();
    if (wa + wb == 0.0 || length == 0.0)
        return;
    const Vec3 step = distance.stiffness * (length - distance.length) / (length * (wa + wb)) * between;
    x[a] += wa * step;
    x[b] -= wb * step;
}

void ShapeKeeper::unfold(const std::vector<char>& patch)
{
    for (size_t i = 0; i < bends_.size(); ++i)
        if (patch[bends_[i].vertex[0]] != 0 || patch[bends_[i].vertex[1]] != 0)
            bends_[i].length = flat_[i];
}

EdgeStrain edge_strain(const JoinedCloths& cloths, View<const Vec3> x)
{
    EdgeStrain strain;
    double sum = 0.0;
    for (int e = 0; e < cloths.edges.edge_count(); ++e) {
        const auto [a, b] = cloths.edges.vertex[e];
        const double change = std::abs((x[a] - x[b]).norm() / cloths.length[e] - 1.0);
        sum += change * change;
        if (change > strain.max) {
            strain.max = change;
            strain.edge = e;
        }
    }
    strain.rms = std::sqrt(sum / std::max(cloths.edges.edge_count(), 1));
    return strain;
}

} // namespace toile::collision
