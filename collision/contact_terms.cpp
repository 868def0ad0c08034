#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "collision/contact.h"

/// How pairs become terms of the contact energy.
namespace toile {

namespace {

/// cos of the angle between the normals of two planes [-] beyond which they squeeze what is between them: 90
/// degrees. More open wedges let cloth slide out.
constexpr double kOpposing = 0.0;

constexpr double kPlenty = std::numeric_limits<double>::infinity();

/// True for a plane of a single cloth vertex.
bool is_plane(const ContactPair& pair) { return !pair.is_between_cloths() && pair.vertex[1] < 0; }

} // namespace

/// Half of the room between each plane of a vertex and the one that opposes it most closely [m], negative
/// where body parts overlap there; kPlenty for pairs that none opposes. A pair of several vertices, each of
/// which may be caught, gets the least of their rooms where that is negative. [pairs]
std::vector<double> Contact::room_of(const std::vector<ContactPair>& pairs) const
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
            if (pairs[i].normal.dot(pairs[j].normal) > kOpposing)
                continue;
            const double half =
                0.5 * (pairs[i].gap(colliders_.found_at()) + pairs[j].gap(colliders_.found_at()));
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

/// The pairs that can move at all become terms of the energy. Faces and edges with a caught vertex are left
/// to the planes of their vertices.
void Contact::make_terms()
{
    std::vector<ContactPair> pairs = colliders_.all();
    if (between_)
        between_->append_pairs(pairs);
    const std::vector<double> room = room_of(pairs);
    std::vector<ContactTerm> terms;
    for (size_t i = 0; i < pairs.size(); ++i) {
        const ContactPair& pair = pairs[i];
        if (!is_plane(pair) && room[i] < 0.0)
            continue;
        bool is_held = true;
        for (int k = 0; k < pair.count(); ++k)
            is_held = is_held && start_.fixed[pair.vertex[k]];
        if (!is_held)
            terms.push_back(make_term(pair, room[i]));
    }
    energy_.set_terms(std::move(terms), start_.x.size());
}

/// Distance that the pair is to keep [m].
double Contact::gap_of(const ContactPair& pair) const
{
    return pair.is_between_cloths() ? between_->thickness_of(pair) : cloths_[cloth_of_[pair.vertex[0]]].gap;
}

/// Coulomb coefficient [-].
double Contact::friction_of(const ContactPair& pair) const
{
    const ContactCloth& cloth = cloths_[cloth_of_[pair.vertex[0]]];
    return pair.is_between_cloths() ? cloth.cloth_friction[cloth_of_[pair.vertex[3]]]
                                    : cloth.partner_friction[pair.collider];
}

/// As stiff as the cloth is there [N/m]; between cloths as the softer of the two sides.
double Contact::stiffness_of(const ContactPair& pair) const
{
    double ahead = 0.0, behind = 0.0;
    for (int k = 0; k < pair.count(); ++k) {
        const double share = pair.weight[k] * start_.diagonal[pair.vertex[k]];
        (share > 0.0 ? ahead : behind) += std::abs(share);
    }
    return settings_.stiffness * (pair.is_between_cloths() ? std::min(ahead, behind) : ahead);
}

/// The pair's cloth point at t0, moved along with the collider unless that jumped.
Vec3 Contact::at_start(const ContactPair& pair) const
{
    const Vec3 start = pair.cloth_point(start_.x);
    return is_carried(pair.motion) ? Vec3(start + pair.motion) : start;
}

bool Contact::is_carried(const Vec3& motion) const
{
    return motion.norm() <= ColliderPairs::kMaxCarrySpeed * start_.dt;
}

/// @param room  half the room between this plane and an opposing one [m]
ContactTerm Contact::make_term(const ContactPair& pair, double room) const
{
    ContactTerm term;
    term.pair = pair;
    term.friction = friction_of(pair);
    term.stiffness = stiffness_of(pair);

    // Cloth that starts inside comes out at the recovery speed, not at once; between two parts it is brought
    // to the middle, where neither can push it through the other, and gripped there by a gap's worth of
    // force.
    const Vec3 start = at_start(pair);
    const double start_gap = pair.normal.dot(start - pair.point);
    term.offset = std::min(gap_of(pair), start_gap + settings_.recovery_speed * start_.dt);
    if (room < 0.0 && room + gap_of(pair) < term.offset) {
        term.offset = room + gap_of(pair);
        term.give = gap_of(pair);
    }
    term.anchor = start;

    memory_.hand_on(term); // the same contact of the step before
    return term;
}

} // namespace toile
