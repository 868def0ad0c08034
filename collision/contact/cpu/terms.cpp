#include "collision/contact/cpu/terms.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/base/stages.h"

namespace toile::collision {

namespace {

constexpr double kPlenty = std::numeric_limits<double>::infinity();

} // namespace

HostContactTerms::HostContactTerms(ContactEnergy& energy, View<const Triangle> triangles,
                                   View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                   const std::vector<ContactCollider>& colliders, const Settings& settings)
    : energy_(energy), tables_(cloths, int(colliders.size()), triangles, positions), settings_(settings),
      colliders_(triangles, positions, colliders,
                 {largest_gap(cloths), settings.face_vertex, settings.edge_edge})
{
    TOILE_ASSERT(int(tables_.cloth_of.size()) == positions.size());
}

void HostContactTerms::begin_step(const StepStart& start, View<const Vec3> carried)
{
    has_remembered_ = false;
    rules_ = rules_of(start, settings_);
    rules_.cloth_of = tables_.cloth_of;
    rules_.gap = tables_.gap;
    rules_.vertex_gap = tables_.vertex_gap;
    rules_.collider_friction = tables_.collider_friction;
    rules_.cloth_friction = tables_.cloth_friction;
    projection_rules_ = projection_rules_of(start);
    projection_rules_.rigid = tables_.rigid;
    projection_rules_.altitude = tables_.altitude;
    colliders_.find(start, carried);
}

/// Half of the clearance between each plane of a vertex and the nearest opposing one, [pairs] [m]. It is
/// negative if body parts overlap, and kPlenty for pairs without an opposing plane. A pair of several
/// vertices, each of which may be caught, gets the smallest of their clearances if that is negative.
std::vector<double> HostContactTerms::clearance_of_planes(const std::vector<ContactPair>& pairs) const
{
    // Planes by vertex.
    std::vector<std::pair<int, int>> planes; // (vertex, pair)
    for (int i = 0; i < int(pairs.size()); ++i)
        if (is_plane(pairs[i]))
            planes.emplace_back(pairs[i].vertex[0], i);
    std::sort(planes.begin(), planes.end());

    std::vector<double> clearance(pairs.size(), kPlenty);
    std::map<int, double> overlap; // by vertex, negative
    for (size_t a = 0; a < planes.size(); ++a)
        for (size_t b = a + 1; b < planes.size() && planes[b].first == planes[a].first; ++b) {
            const auto [v, i] = planes[a];
            const int j = planes[b].second;
            if (!are_opposing(pairs[i], pairs[j]))
                continue;
            const double half = half_clearance(pairs[i], pairs[j], colliders_.found_at());
            clearance[i] = std::min(clearance[i], half);
            clearance[j] = std::min(clearance[j], half);
            if (half < 0.0)
                overlap[v] = std::min(overlap[v], half);
        }
    if (overlap.empty())
        return clearance;
    for (size_t i = 0; i < pairs.size(); ++i)
        for (int k = 0; k < pairs[i].count() && pairs[i].kind < ContactKind::kGuard && !is_plane(pairs[i]);
             ++k)
            if (const auto caught = overlap.find(pairs[i].vertex[k]); caught != overlap.end())
                clearance[i] = std::min(clearance[i], caught->second);
    return clearance;
}

void HostContactTerms::make(const ClothContact* between)
{
    const StageScope stage("contact/make");
    std::vector<ContactPair> pairs = colliders_.all();
    if (between) {
        rules_.thickness = between->thickness();
        between->append_pairs(pairs);
    }
    const std::vector<double> clearance = clearance_of_planes(pairs);
    const ReplacedPairs replaced = between ? between->replaced() : ReplacedPairs{};
    std::vector<ContactTerm> terms;
    for (size_t i = 0; i < pairs.size(); ++i) {
        if ((!is_plane(pairs[i]) && clearance[i] < 0.0) || rules_.is_fixed(pairs[i]) ||
            replaced(pairs[i], clearance[i]))
            continue;
        terms.push_back(rules_.term_of(pairs[i], clearance[i], replaced.pinched(pairs[i])));
        memory_.warm_start(terms.back()); // the same contact of the step before
    }
    energy_.set_terms(std::move(terms), rules_.x.size());
}

TermSums HostContactTerms::update_forces()
{
    TermSums sum;
    const UpdateForce query{energy_.change_terms(), x_};
    for (int i = 0; i < query.terms.size(); ++i)
        sum += query(i);
    return sum;
}

void HostContactTerms::adopt_forces()
{
    const AdoptForce adopt{energy_.change_terms()};
    for (int i = 0; i < adopt.terms.size(); ++i)
        adopt(i);
}

void HostContactTerms::update_multipliers(bool is_near)
{
    const UpdateMultiplier update{energy_.change_terms(), is_near};
    for (int i = 0; i < update.terms.size(); ++i)
        update(i);
}

void HostContactTerms::mark_touching(View<unsigned char> touches)
{
    for (const ContactTerm& term : energy_.terms())
        if (term.gap(x_) < 0.0)
            for (int k = 0; k < term.pair.count(); ++k)
                touches[term.pair.vertex[k]] = 1;
}

std::vector<unsigned char> HostContactTerms::supported()
{
    std::vector<unsigned char> supported(x_.size(), 0);
    const ContactQuery query = this->query();
    for (int i = 0; i < query.terms.size(); ++i) {
        if (!query.is_supported(i, rules_))
            continue;
        const ContactPair& pair = query.terms[i].pair;
        for (int k = 0; k < pair.count(); ++k)
            supported[pair.vertex[k]] = 1;
    }
    return supported;
}

bool HostContactTerms::has_left(double trust)
{
    out_of_bounds_.assign(x_.size(), 0);
    bool any = false;
    const ContactQuery query = this->query();
    for (int i = 0; i < query.terms.size(); ++i) {
        if (!query.has_slid(i, rules_, colliders_.found_at(), trust))
            continue;
        const ContactPair& pair = query.terms[i].pair;
        for (int k = 0; k < pair.count(); ++k)
            out_of_bounds_[pair.vertex[k]] = 1;
        any = true;
    }
    return colliders_.mark_unseen(x_, out_of_bounds_) || any;
}

void HostContactTerms::find_again() { colliders_.find_again(x_, out_of_bounds_); }

double HostContactTerms::deepest()
{
    double depth = 0.0;
    const ContactQuery query = this->query();
    for (int i = 0; i < query.terms.size(); ++i)
        if (!query.terms[i].pair.is_between_cloths())
            depth = std::max(depth, query.depth(i));
    return depth;
}

bool HostContactTerms::project_compliant(int sweeps)
{
    projection_force_.assign(energy_.terms().size(), 0.0);
    return gauss_seidel_.sweep(energy_.terms(),
                               ProjectCompliant{projection_rules_, projection_force_, seen_.change_on_host()},
                               sweeps);
}

void HostContactTerms::project_normal(double max_depth)
{
    gauss_seidel_.sweep(energy_.terms(), ProjectNormal{projection_rules_, max_depth, seen_.change_on_host()},
                        kClearSweeps);
}

void HostContactTerms::stop_at_surfaces(StepField v)
{
    gauss_seidel_.sweep(energy_.terms(), StopAtSurface{projection_rules_, x_, v.change_on_host()}, 1);
}

void HostContactTerms::project_friction(StepField v)
{
    gauss_seidel_.sweep(energy_.terms(),
                        ProjectFriction{projection_rules_, seen_.change_on_host(), v.change_on_host()}, 1);
}

void HostContactTerms::remember(Slip slip)
{
    if (!has_remembered_)
        std::swap(memory_, memory_of_start_);
    has_remembered_ = true;
    memory_.forget();
    for (const ContactTerm& term : energy_.terms())
        memory_.keep(term, rules_.slip_of(term, slip, x_));
}

double HostContactTerms::end_step()
{
    double min_gap = 0.0;
    for (size_t i = 0; i < energy_.terms().size(); ++i) {
        const double gap = energy_.terms()[i].pair.gap(x_);
        min_gap = i == 0 ? gap : std::min(min_gap, gap);
    }
    colliders_.update_sides(x_);
    return min_gap;
}

void HostContactTerms::abandon_step()
{
    if (has_remembered_)
        std::swap(memory_, memory_of_start_);
    has_remembered_ = false;
}

void HostContactTerms::forget()
{
    memory_.forget();
    memory_of_start_.forget();
    colliders_.forget();
}

} // namespace toile::collision
