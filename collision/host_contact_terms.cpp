#include "collision/host_contact_terms.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/backend/stages.h"

namespace toile {

namespace {

constexpr double kPlenty = std::numeric_limits<double>::infinity();

} // namespace

HostContactTerms::HostContactTerms(ContactEnergy& energy, View<const Triangle> triangles,
                                   View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                   const std::vector<ContactPartner>& partners, const Settings& settings)
    : energy_(energy), tables_(cloths, int(partners.size()), triangles, positions), settings_(settings),
      colliders_(triangles, positions, partners,
                 {largest_gap(cloths), settings.face_vertex, settings.edge_edge})
{
    TOILE_ASSERT(int(tables_.cloth_of.size()) == positions.size());
}

void HostContactTerms::begin_step(const StepStart& start)
{
    rules_ = rules_of(start, settings_);
    rules_.cloth_of = tables_.cloth_of;
    rules_.gap = tables_.gap;
    rules_.partner_friction = tables_.partner_friction;
    rules_.cloth_friction = tables_.cloth_friction;
    push_rules_ = push_rules_of(start);
    push_rules_.rigid = tables_.rigid;
    push_rules_.altitude = tables_.altitude;
    colliders_.find(start);
}

/// Half of the room between each plane of a vertex and the one that opposes it most closely [m], negative
/// where body parts overlap there; kPlenty for pairs that none opposes. A pair of several vertices, each of
/// which may be caught, gets the least of their rooms where that is negative. [pairs]
std::vector<double> HostContactTerms::room_of(const std::vector<ContactPair>& pairs) const
{
    // Planes by vertex.
    std::vector<std::pair<int, int>> planes; // (vertex, pair)
    for (int i = 0; i < int(pairs.size()); ++i)
        if (is_plane(pairs[i]))
            planes.emplace_back(pairs[i].vertex[0], i);
    std::sort(planes.begin(), planes.end());

    std::vector<double> room(pairs.size(), kPlenty);
    std::map<int, double> overlap; // by vertex, negative
    for (size_t a = 0; a < planes.size(); ++a)
        for (size_t b = a + 1; b < planes.size() && planes[b].first == planes[a].first; ++b) {
            const auto [v, i] = planes[a];
            const int j = planes[b].second;
            if (!are_opposing(pairs[i], pairs[j]))
                continue;
            const double half = half_room(pairs[i], pairs[j], colliders_.found_at());
            room[i] = std::min(room[i], half);
            room[j] = std::min(room[j], half);
            if (half < 0.0)
                overlap[v] = std::min(overlap[v], half);
        }
    if (overlap.empty())
        return room;
    for (size_t i = 0; i < pairs.size(); ++i)
        for (int k = 0; k < pairs[i].count() && !pairs[i].is_between_cloths() && !is_plane(pairs[i]); ++k)
            if (const auto caught = overlap.find(pairs[i].vertex[k]); caught != overlap.end())
                room[i] = std::min(room[i], caught->second);
    return room;
}

void HostContactTerms::make(const ClothContact* between)
{
    const StageScope stage("contact/make");
    std::vector<ContactPair> pairs = colliders_.all();
    if (between) {
        rules_.thickness = between->thickness();
        between->append_pairs(pairs);
    }
    const std::vector<double> room = room_of(pairs);
    std::vector<ContactTerm> terms;
    for (size_t i = 0; i < pairs.size(); ++i) {
        if ((!is_plane(pairs[i]) && room[i] < 0.0) || rules_.is_fixed(pairs[i]))
            continue;
        terms.push_back(rules_.term_of(pairs[i], room[i]));
        memory_.hand_on(terms.back()); // the same contact of the step before
    }
    energy_.set_terms(std::move(terms), rules_.x.size());
}

FrictionLimits HostContactTerms::look_at_forces()
{
    FrictionLimits sum;
    const LookAtForce look{energy_.change_terms(), x_};
    for (int i = 0; i < look.terms.size(); ++i)
        sum += look(i);
    return sum;
}

void HostContactTerms::adopt_forces()
{
    const AdoptForce adopt{energy_.change_terms()};
    for (int i = 0; i < adopt.terms.size(); ++i)
        adopt(i);
}

std::vector<unsigned char> HostContactTerms::leaning()
{
    std::vector<unsigned char> leans(x_.size(), 0);
    const ContactLook look = this->look();
    for (int i = 0; i < look.terms.size(); ++i) {
        if (!look.is_leaning(i, rules_))
            continue;
        const ContactPair& pair = look.terms[i].pair;
        for (int k = 0; k < pair.count(); ++k)
            leans[pair.vertex[k]] = 1;
    }
    return leans;
}

bool HostContactTerms::has_left(double trust)
{
    strays_.assign(x_.size(), 0);
    bool any = false;
    const ContactLook look = this->look();
    for (int i = 0; i < look.terms.size(); ++i) {
        if (!look.has_slid(i, rules_, colliders_.found_at(), trust))
            continue;
        const ContactPair& pair = look.terms[i].pair;
        for (int k = 0; k < pair.count(); ++k)
            strays_[pair.vertex[k]] = 1;
        any = true;
    }
    return colliders_.mark_unseen(x_, strays_) || any;
}

void HostContactTerms::find_again() { colliders_.find_again(x_, strays_); }

double HostContactTerms::deepest()
{
    double depth = 0.0;
    const ContactLook look = this->look();
    for (int i = 0; i < look.terms.size(); ++i)
        if (!look.terms[i].pair.is_between_cloths())
            depth = std::max(depth, look.depth(i));
    return depth;
}

bool HostContactTerms::push_to_rest(int sweeps)
{
    push_force_.assign(energy_.terms().size(), 0.0);
    return turns_.sweep(energy_.terms(), PushToRest{push_rules_, push_force_, seen_.change_on_host()},
                        sweeps);
}

void HostContactTerms::push_out(double most)
{
    turns_.sweep(energy_.terms(), PushOut{push_rules_, most, seen_.change_on_host()}, kClearSweeps);
}

void HostContactTerms::stop_at_surfaces(StepField v)
{
    turns_.sweep(energy_.terms(), StopAtSurface{push_rules_, x_, v.change_on_host()}, 1);
}

void HostContactTerms::rub(StepField v)
{
    turns_.sweep(energy_.terms(), Rub{push_rules_, seen_.change_on_host(), v.change_on_host()}, 1);
}

void HostContactTerms::remember(Slip slip)
{
    memory_.forget();
    for (const ContactTerm& term : energy_.terms())
        memory_.keep(term, rules_.slip_of(term, slip, x_));
}

double HostContactTerms::end_step()
{
    double least = 0.0;
    for (size_t i = 0; i < energy_.terms().size(); ++i) {
        const double gap = energy_.terms()[i].pair.gap(x_);
        least = i == 0 ? gap : std::min(least, gap);
    }
    colliders_.learn_sides(x_);
    return least;
}

void HostContactTerms::forget()
{
    memory_.forget();
    colliders_.forget();
}

} // namespace toile
