#include "collision/contact.h"

#include "collision/device_contact_terms.h"
#include "collision/host_contact_terms.h"
#include "core/backend/stages.h"

namespace toile {

namespace {

/// Distance [m] that cloth may move from where its active pairs were found: beyond, a curved surface has left
/// its tangent plane by more than about half a millimetre (radius of curvature 5 cm).
constexpr double kTrust = 0.007;

/// The same at the end of a step, and depth [m] that a step may end with, for which nothing is looked at
/// again: cloth at rest costs nothing then.
constexpr double kEndTrust = 0.002;
constexpr double kLeftOver = 1e-4;

/// Relative change of the friction limits that calls for another minimisation [-]: cloth that lands. At 0.1 a
/// walking skirt was minimised three times a step for nothing that could be measured.
constexpr double kFrictionChange = 0.5;

std::unique_ptr<ContactTerms> make_terms(ContactEnergy& energy, View<const Triangle> triangles,
                                         View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                         const std::vector<ContactPartner>& partners,
                                         const Contact::Settings& asked, const CudaSpace* space)
{
    const ContactTerms::Settings settings{asked.stiffness, asked.recovery_speed, asked.face_vertex,
                                          asked.edge_edge};
    if (space != nullptr)
        return std::make_unique<DeviceContactTerms>(*space, triangles, positions, cloths, partners, settings);
    return std::make_unique<HostContactTerms>(energy, triangles, positions, cloths, partners, settings);
}

} // namespace

Contact::Contact(View<const Triangle> triangles, View<const Vec3> positions,
                 const std::vector<ContactCloth>& cloths, const std::vector<ContactPartner>& partners,
                 const Settings& settings, const CudaSpace* space)
    : terms_(make_terms(energy_, triangles, positions, cloths, partners, settings, space))
{
    if (settings.cloth_with_cloth)
        between_ =
            make_cloth_contact(triangles, positions, cloths, shortest_altitudes(triangles, positions), space);
}

void Contact::begin_step(const StepStart& start)
{
    dt_ = start.dt;
    has_cleared_ = false;
    if (between_)
        between_->begin_step(start);
    terms_->begin_step(start);
    if (between_)
        between_->end_search();
    terms_->make(between_.get());
}

void Contact::forget()
{
    terms_->forget();
    if (between_)
        between_->forget();
}

double Contact::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    return energy_.terms().empty() ? 0.0 : energy_.add_gradient(x, gradient);
}

bool Contact::activate(View<const Vec3> x) { return !energy_.terms().empty() && energy_.activate(x); }

void Contact::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    energy_.add_hessian_product(p, out);
}

bool Contact::make_feasible(StepField x) const
{
    terms_->see(x);
    return terms_->push_to_rest(kGuessSweeps);
}

bool Contact::sweep_once(StepField x) const
{
    terms_->see(x);
    return terms_->push_to_rest(1);
}

bool Contact::revise(StepField x, bool is_settled)
{
    if (terms_->empty() && !between_)
        return false;
    terms_->see(x);
    const FrictionLimits friction = terms_->look_at_forces();
    const bool has_landed = is_settled && friction.change > kFrictionChange * friction.total;
    if (has_landed)
        terms_->adopt_forces();
    const bool has_new_pairs = between_ && between_->advance(x, [&] { return terms_->leaning(); });
    if (terms_->has_left(kTrust) || has_new_pairs) {
        terms_->remember(RememberedSlip::kByStart);
        find_again();
        return true;
    }
    return has_landed;
}

/// The pairs of what has left its own, and all terms.
void Contact::find_again()
{
    terms_->find_again();
    terms_->make(between_.get());
}

/// How the minimiser has ended.
void Contact::remember_end()
{
    terms_->adopt_forces();
    terms_->remember(RememberedSlip::kSoFar);
}

void Contact::end_step(StepField x)
{
    terms_->see(x);
    if (!has_cleared_)
        remember_end();
    active_count_ = terms_->remembered();
    min_gap_ = terms_->end_step();
    if (between_)
        between_->end_step(x);
}

/// Looks where the cloth has come to and moves it out of what is still inside there. This correction does not
/// become velocity, or it would throw the cloth. Again in the same step, it forgets pairs that it has parted:
/// friction there would drag cloth that is caught.
void Contact::clear(StepField x, StepField v)
{
    terms_->see(x);
    if (!terms_->has_left(kEndTrust) && terms_->deepest() <= kLeftOver)
        return;
    remember_end();
    has_cleared_ = true;
    find_again();
    const StageScope stage("collision/clear");
    terms_->stop_at_surfaces(v);
    terms_->push_out(kLeftOver);
}

/// What would have crossed stops: it loses the velocity that it was to have got there.
bool Contact::keep_apart(StepField x, StepField v)
{
    terms_->see(x);
    return between_ && between_->hold_back(x, v, dt_, [&] { return terms_->leaning(); });
}

/// Nothing of a stick stays for the next step: friction has undone it.
void Contact::resolve(StepField x, StepField v)
{
    terms_->see(x);
    if (terms_->has_left(kEndTrust))
        find_again();
    const StageScope stage("collision/resolve");
    terms_->look_at_forces();
    terms_->adopt_forces();
    terms_->remember(RememberedSlip::kNothing);
    has_cleared_ = true;
    terms_->rub(v);
    terms_->push_out(0.0);
}

} // namespace toile
