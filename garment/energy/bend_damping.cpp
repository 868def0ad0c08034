#include "garment/energy/bend_damping.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/compute/parallel_lanes.h"
#include "garment/energy/cuda/bend_damping.h"

namespace toile::garment {

namespace {

/// Rate of the curvature above which friction is dry [1/(m s)].
constexpr double kSlipRate = 20.0;

/// Altitude of a triangle's apex over an edge, and the foot's place along it.
struct Altitude {
    double height; ///< [m]
    double foot;   ///< [-] 0 at the edge's first vertex, 1 at the second
    Vec2 across;   ///< unit vector in material axes
};

/// @param first, second, apex  corners of triangle t; the edge goes from `first` to `second`
Altitude altitude_of(const RestShape& rest, int t, int first, int second, int apex)
{
    const auto place = [&](int v) {
        const Triangle& corner = rest.triangles[t];
        return v == corner[0] ? Vec2(Vec2::Zero()) : Vec2(rest.edges[t].col(v == corner[1] ? 0 : 1));
    };
    const Vec2 edge = place(second) - place(first), side = place(apex) - place(first);
    Altitude altitude;
    altitude.foot = edge.dot(side) / edge.squaredNorm();
    const Vec2 across = side - altitude.foot * edge;
    altitude.height = across.norm();
    altitude.across = across / altitude.height;
    return altitude;
}

/// Roots of the rigidities across warp and weft.
Vec2 root_of(const Bending::Settings& rigidity)
{
    return {std::sqrt(rigidity.warp), std::sqrt(rigidity.weft)};
}

void require_valid(const BendDamping::Settings& s, const std::string& source)
{
    if (!(s.time >= 0.0) || !std::isfinite(s.time))
        throw InvalidInput(source + ": damping of bending = " + std::to_string(s.time) +
                           " s; it must be 0 or more");
    if (!(s.friction >= 0.0) || !std::isfinite(s.friction))
        throw InvalidInput(source + ": friction of bending = " + std::to_string(s.friction) +
                           " 1/m; it must be 0 or more");
}

} // namespace

BendDamping::BendDamping(const RestShape& rest, const ByFabric<Settings>& settings, const std::string& source,
                         const std::vector<int>& hinges)
{
    for (const Settings& fabric : settings.settings)
        require_valid(fabric, source);
    std::vector<bool> is_hinge(rest.topology.edges.size(), false);
    for (const int edge : hinges)
        is_hinge[size_t(edge)] = true;
    for (size_t e = 0; e < rest.topology.edges.size(); ++e) {
        const Edge& edge = rest.topology.edges[e];
        if (is_hinge[e] || edge.is_border() || rest.is_sliver(edge.triangle[0]) ||
            rest.is_sliver(edge.triangle[1]))
            continue;
        const auto [v0, v1] = edge.vertex;
        const auto [a, b] = edge.opposite;
        const Altitude over_a = altitude_of(rest, edge.triangle[0], v0, v1, a);
        const Altitude over_b = altitude_of(rest, edge.triangle[1], v0, v1, b);
        const double area = rest.areas[edge.triangle[0]] + rest.areas[edge.triangle[1]];
        const double length = 2.0 * rest.areas[edge.triangle[0]] / over_a.height;
        const Vec2 across = 0.5 * (over_a.across.cwiseAbs2() + over_b.across.cwiseAbs2());
        const Settings &a_settings = settings.at(edge.triangle[0]),
                       &b_settings = settings.at(edge.triangle[1]);
        const Vec2 a_root = std::sqrt(settings.stiffness_of(edge.triangle[0])) * root_of(a_settings.rigidity),
                   b_root = std::sqrt(settings.stiffness_of(edge.triangle[1])) * root_of(b_settings.rigidity);
        const double root = across.dot(0.5 * (a_root + b_root));
        const double rigidity = root * root;

        Hinge hinge;
        hinge.vertex = {v0, v1, a, b};
        const double wa = 1.0 / over_a.height, wb = 1.0 / over_b.height;
        hinge.weight = {(over_a.foot - 1.0) * wa + (over_b.foot - 1.0) * wb,
                        -over_a.foot * wa - over_b.foot * wb, wa, wb};
        hinge.viscous = 3.0 * rigidity * length * length / area * (0.5 * (a_settings.time + b_settings.time));
        hinge.dry = 0.5 * (a_settings.friction + b_settings.friction) * rigidity * length;
        hinge.slip_rate = kSlipRate * area / (3.0 * length);
        hinges_.push_back(hinge);
    }
    start_.resize(hinges_.size());
    force_.resize(hinges_.size());
    energy_.resize(hinges_.size());
    stiffness_.resize(hinges_.size());

    slots_of_vertex_.first.assign(rest.vertex_count() + 1, 0);
    for (const Hinge& hinge : hinges_)
        for (const int v : hinge.vertex)
            ++slots_of_vertex_.first[v + 1];
    std::partial_sum(slots_of_vertex_.first.begin(), slots_of_vertex_.first.end(),
                     slots_of_vertex_.first.begin());
    slots_of_vertex_.items.resize(slots_of_vertex_.first.back());
    std::vector<int> next(slots_of_vertex_.first.begin(), slots_of_vertex_.first.end() - 1);
    for (int h = 0; h < int(hinges_.size()); ++h)
        for (int k = 0; k < 4; ++k)
            slots_of_vertex_.items[next[hinges_[h].vertex[k]]++] = 4 * h + k;
}

/// Folds of a block of eight hinges.
Fold<Lanes> BendDamping::folds(View<const Vec3> x, int block) const
{
    const int first = block * kLanes, count = int(hinges_.size());
    Vec3Of<Lanes> corner[4];
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 3; ++i)
            corner[k][i] = gather(first, count, [&](int h) { return x[hinges_[h].vertex[k]][i]; });
    return fold_of<Lanes>(corner[0], corner[1], corner[2], corner[3]);
}

HingeResponse<Lanes> BendDamping::response(const Fold<Lanes>& fold, int block) const
{
    const int first = block * kLanes, count = int(hinges_.size());
    const auto of_hinges = [&](const auto& value) { return gather(first, count, value); };
    const Lanes share = of_hinges([&](int h) { return start_[h].share; });
    return hinge_response<Lanes>(fold.s - of_hinges([&](int h) { return start_[h].s; }),
                                 share * of_hinges([&](int h) { return hinges_[h].viscous / dt_; }),
                                 share * of_hinges([&](int h) { return hinges_[h].dry; }),
                                 of_hinges([&](int h) { return hinges_[h].slip_rate * dt_; }));
}

void BendDamping::begin_step(View<const Vec3> x, double dt)
{
    dt_ = dt;
    const int count = int(hinges_.size());
    parallel_for_lanes(kCpu, "bend_damping/start", count, [&](int block) {
        const Lanes s = folds(x, block).s;
        for (int k = 0; k < std::min(kLanes, count - block * kLanes); ++k) {
            const int h = block * kLanes + k;
            start_[h] = {s[k], friction_share(hinges_[h], x)};
        }
    });
}

double BendDamping::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    if (dt_ == 0.0)
        return 0.0;
    const int count = int(hinges_.size());
    parallel_for_lanes(kCpu, "bend_damping/fold", count, [&](int block) {
        const Fold<Lanes> fold = folds(x, block);
        const HingeResponse<Lanes> change = response(fold, block);
        const Vec3Of<Lanes>* const by[4] = {&fold.v0, &fold.v1, &fold.a, &fold.b};
        for (int k = 0; k < std::min(kLanes, count - block * kLanes); ++k) {
            const int h = block * kLanes + k;
            energy_[h] = change.energy[k];
            for (int slot = 0; slot < 4; ++slot)
                for (int i = 0; i < 3; ++i)
                    force_[h][slot][i] = change.moment[k] * (*by[slot])[i][k];
        }
    });
    parallel_for(kCpu, "bend_damping/gather", gradient.size(), [&](int v) {
        Vec3 sum = Vec3::Zero();
        for (const int slot : slots_of_vertex_.of(v))
            sum += force_[slot / 4][slot % 4];
        gradient[v] += sum;
    });
    return parallel_sum(kCpu, count, 0.0, [&](int h) { return energy_[h]; });
}

void BendDamping::add_constant_curvature(Triplets& S) const
{
    for (const Hinge& hinge : hinges_)
        for (const int i : hinge.vertex)
            for (const int j : hinge.vertex)
                S.emplace_back(i, j, 0.0);
}

bool BendDamping::find_entries(SparseWindow S, BlockWindow)
{
    position_.resize(slots_of_vertex_.items.size());
    for (int v = 0; v + 1 < int(slots_of_vertex_.first.size()); ++v)
        for (int at = slots_of_vertex_.first[v]; at < slots_of_vertex_.first[v + 1]; ++at)
            for (int k = 0; k < 4; ++k)
                position_[at][k] = S.position(v, hinges_[slots_of_vertex_.items[at] / 4].vertex[k]);
    return true;
}

void BendDamping::add_isotropic_curvature(View<const Vec3> x, SparseWindow S)
{
    if (dt_ == 0.0)
        return;
    const int count = int(hinges_.size());
    parallel_for_lanes(kCpu, "bend_damping/stiffness", count, [&](int block) {
        const Fold<Lanes> fold = folds(x, block);
        const Lanes stiffness = response(fold, block).stiffness * fold.cosine * fold.cosine;
        for (int k = 0; k < std::min(kLanes, count - block * kLanes); ++k)
            stiffness_[block * kLanes + k] = stiffness[k];
    });
    parallel_for(kCpu, "bend_damping/rows", x.size(), [&](int v) {
        double* const row = S.values(v);
        for (int at = slots_of_vertex_.first[v]; at < slots_of_vertex_.first[v + 1]; ++at) {
            const int slot = slots_of_vertex_.items[at];
            const Hinge& hinge = hinges_[slot / 4];
            const double factor = stiffness_[slot / 4] * hinge.weight[slot % 4];
            for (int k = 0; k < 4; ++k)
                row[position_[at][k]] += factor * hinge.weight[k];
        }
    });
}

bool BendDamping::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceBendDamping>().add(hinges_, slots_of_vertex_, first_vertex);
    return true;
}

} // namespace toile::garment
