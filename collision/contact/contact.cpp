#include "collision/contact/contact.h"

#include "collision/contact/cpu/terms.h"
#include "collision/contact/cuda/terms.h"
#include "core/base/stages.h"

namespace toile::collision {

namespace {

/// Distance [m] that cloth may move from where its active pairs were found. Beyond that, a curved surface has
/// left its tangent plane by more than about half a millimetre (radius of curvature 5 cm).
constexpr double kTrust = 0.007;

/// Distance as kTrust at the end of a step, and depth [m] that a step may end with, up to which pairs are not
/// searched for again: resting cloth then costs nothing.
constexpr double kEndTrust = 0.002;
constexpr double kLeftOver = 1e-4;

/// Relative change of the friction limits that requires another minimisation [-], as for cloth that lands. At
/// 0.1 a walking skirt takes three minimisations per step, without measurable benefit.
constexpr double kFrictionChange = 0.5;

/// Such minimisations in a step, and those in which cloth is pressed out of a shape. Forces of cloth between
/// two others may go to and fro without end.
constexpr int kMaxLandings = 8, kMaxPresses = 8;

std::unique_ptr<ContactTerms> make_terms(ContactEnergy& energy, View<const Triangle> triangles,
                                         View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                         const std::vector<ContactCollider>& colliders,
                                         const Contact::Settings& asked, const CudaSpace* space)
{
    const ContactTerms::Settings settings{asked.stiffness, asked.recovery_speed, asked.face_vertex,
                                          asked.edge_edge};
    if (space != nullptr)
        return std::make_unique<DeviceContactTerms>(*space, triangles, positions, cloths, colliders,
                                                    settings);
    return std::make_unique<HostContactTerms>(energy, triangles, positions, cloths, colliders, settings);
}

} // namespace

Contact::Contact(View<const Triangle> triangles, View<const Vec3> positions,
                 const std::vector<ContactCloth>& cloths, const std::vector<ContactCollider>& colliders,
                 const Settings& settings, const CudaSpace* space)
    : between_(make_cloth_contact(triangles, positions, cloths, shortest_altitudes(triangles, positions),
                                  colliders, settings.cloth_with_cloth, space)),
      terms_(make_terms(energy_, triangles, positions, cloths, colliders, settings, space))
{
}

Contact::~Contact() = default;

void Contact::begin_step(const StepStart& start)
{
    dt_ = start.dt;
    has_cleared_ = is_near_ = false;
    landings_ = presses_ = 0;
    energy_.use_true_hessian(start.wants_true_hessian);
    if (between_)
        between_->begin_step(start, *terms_);
    terms_->begin_step(start, between_ ? between_->carried() : View<const Vec3>());
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

bool Contact::may_be_active() const { return !terms_->empty(); }

DeviceActiveSet* Contact::on_device(const CudaSpace& space) { return terms_->on_device(space); }

void Contact::mark_touching(StepField x, View<unsigned char> touches)
{
    terms_->see(x);
    terms_->mark_touching(touches);
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
    return terms_->project_compliant(kGuessSweeps);
}

bool Contact::sweep_once(StepField x) const
{
    terms_->see(x);
    return terms_->project_compliant(1);
}

bool Contact::revise(StepField x, MinimiserProgress progress)
{
    const bool is_converged = progress >= MinimiserProgress::kConverged;
    if (terms_->empty() && !between_)
        return false;
    terms_->see(x);
    const TermSums sums = terms_->update_forces();
    const bool has_landed =
        is_converged && landings_ < kMaxLandings && sums.change > kFrictionChange * sums.total;
    if (has_landed) {
        terms_->adopt_forces();
        ++landings_;
    }
    is_near_ = progress != MinimiserProgress::kFar;
    const bool looks = between_ && (is_converged || !between_->is_clear());
    const bool has_new_pairs = looks && between_->advance(x, [&] { return terms_->supported(); });
    const bool is_limited = looks && between_->has_limited();
    const bool has_sunk = is_converged && presses_ < kMaxPresses && sums.sunk_count > 0;
    if (has_sunk)
        ++presses_;
    if (is_limited || has_sunk)
        terms_->update_multipliers(is_near_);
    if (terms_->has_left(kTrust) || has_new_pairs) {
        terms_->remember(RememberedSlip::kByStart);
        find_again();
        if (progress != MinimiserProgress::kSettled || is_limited)
            return true;
    }
    return has_landed || has_sunk || (is_limited && sums.short_count > 0);
}

/// Finds the pairs of vertices that have left theirs, and makes all terms.
void Contact::find_again()
{
    terms_->find_again();
    terms_->make(between_.get());
}

/// Stores forces and slip at the end of the minimisation.
void Contact::remember_end()
{
    terms_->adopt_forces();
    terms_->update_multipliers(is_near_);
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

void Contact::abandon_step()
{
    terms_->abandon_step();
    if (between_)
        between_->abandon_step();
}

/// Searches at the current positions, and moves cloth out of colliders that it is still inside. This
/// correction does not become velocity, or it would throw the cloth. A second call in the same step forgets
/// pairs that the first has parted: their friction would drag caught cloth.
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
    terms_->project_normal(kLeftOver);
}

/// Stops cloth that would have crossed, and removes the velocity of the correction.
bool Contact::keep_apart(StepField x, StepField v)
{
    terms_->see(x);
    return between_ && between_->limit_motion(x, v, dt_, [&] { return terms_->supported(); });
}

/// Projects contact with friction. No elastic slip stays for the next step: friction has undone it.
void Contact::resolve(StepField x, StepField v)
{
    terms_->see(x);
    if (terms_->has_left(kEndTrust))
        find_again();
    const StageScope stage("collision/resolve");
    terms_->update_forces();
    terms_->adopt_forces();
    terms_->remember(RememberedSlip::kNothing);
    has_cleared_ = true;
    terms_->project_friction(v);
    terms_->project_normal(0.0);
}

} // namespace toile::collision
