#include <algorithm>
#include <cmath>

#include "collision/contact.h"

/// How pairs become terms of the contact energy.
namespace toile {

/// The pairs that can move at all become terms of the energy.
void Contact::make_terms(const std::vector<ContactPair>& pairs)
{
    std::vector<ContactTerm> terms;
    for (const ContactPair& pair : pairs) {
        bool is_held = true;
        for (int k = 0; k < pair.count(); ++k)
            is_held = is_held && start_.fixed[pair.vertex[k]];
        if (!is_held)
            terms.push_back(make_term(pair));
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

bool Contact::is_carried(const Vec3& motion) const { return motion.norm() <= kMaxCarrySpeed * start_.dt; }

ContactTerm Contact::make_term(const ContactPair& pair) const
{
    ContactTerm term;
    term.pair = pair;
    term.friction = friction_of(pair);
    term.stiffness = stiffness_of(pair);

    // Cloth that starts inside comes out at the recovery speed, not at once.
    const Vec3 start = at_start(pair);
    const double start_gap = pair.normal.dot(start - pair.point);
    term.offset = std::min(gap_of(pair), start_gap + settings_.recovery_speed * start_.dt);
    term.anchor = start;

    memory_.hand_on(term); // the same contact of the step before
    return term;
}

} // namespace toile
