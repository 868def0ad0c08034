#include "core/pd/rigid/rigid_active_set.h"

#include <algorithm>

namespace toile {

namespace {

/// Scale of penalties at a rigid surface relative to its inertia [-]. A box at rest on its four corners sinks
/// by g dt^2 / (2 kStiffening): 17 micrometres at 1/120 s. Cloth has the stiffness of its membrane, a rigid
/// body only its inertia. Below 5 an impact at 1 m/s uses up a contact offset of one millimetre, and
/// CollisionFreeStep has to stop it.
constexpr double kStiffening = 20.0;

} // namespace

RigidActiveSet::RigidActiveSet(ActiveSetEnergy& surface, const RigidBodies& bodies, int free_count)
    : surface_(surface), bodies_(bodies), free_count_(free_count)
{
    const size_t vertices = size_t(free_count) + bodies.vertex_count();
    start_.resize(vertices);
    prediction_.resize(vertices);
    diagonal_.resize(vertices);
    fixed_.assign(vertices, 0);
    x_.resize(vertices);
    field_.resize(vertices);
    blocks_.resize(size_t(free_count) + bodies.unknown_count());
    std::copy(bodies.surface().begin(), bodies.surface().end(), x_.begin() + free_count);
}

void RigidActiveSet::to_surface(View<const Vec3> q, View<Vec3> x) const
{
    std::copy_n(q.begin(), free_count_, x.begin());
    bodies_.place(unknowns(q), rigid_part(x));
}

void RigidActiveSet::take_free(View<const Vec3> x, View<Vec3> q) const
{
    std::copy_n(x.begin(), free_count_, q.begin());
}

/// Fits the unknowns of bodies whose surface was moved, and copies the free points.
void RigidActiveSet::take_moved(View<const Vec3> before, View<const Vec3> x, View<Vec3> q) const
{
    take_free(x, q);
    for (int body = 0; body < bodies_.count(); ++body) {
        const int first = free_count_ + bodies_.first_vertex(body);
        const int count = int(bodies_.shape(body).points.size());
        if (!std::equal(x.begin() + first, x.begin() + first + count, before.begin() + first))
            bodies_.fit(body, x.subview(first, count), q.subview(free_count_ + 2 * body, 2));
    }
}

void RigidActiveSet::begin_step(const StepStart& start)
{
    dt_ = start.dt;
    std::copy_n(start.x.begin(), free_count_, start_.begin());
    std::copy(bodies_.surface().begin(), bodies_.surface().end(), start_.begin() + free_count_);
    to_surface(start.prediction, prediction_);
    std::copy_n(start.diagonal.begin(), free_count_, diagonal_.begin());
    std::copy_n(start.fixed.begin(), free_count_, fixed_.begin());
    for (int v = 0; v < bodies_.vertex_count(); ++v)
        diagonal_[free_count_ + v] = kStiffening * bodies_.inertia(v, start.dt);
    surface_.begin_step(
        {start_, prediction_, diagonal_, fixed_, start.masses, start.dt, {}, start.wants_true_hessian});
}

bool RigidActiveSet::make_feasible(StepField positions) const
{
    return project_free(positions, [&] { return surface_.make_feasible(x_); });
}

bool RigidActiveSet::sweep_once(StepField positions) const
{
    return project_free(positions, [&] { return surface_.sweep_once(x_); });
}

/// Projects the free points only: projected one by one, the vertices of a body would separate.
template <typename Projection>
bool RigidActiveSet::project_free(StepField positions, const Projection& projection) const
{
    const View<Vec3> q = positions.change_on_host();
    to_surface(q, x_);
    const bool moved = projection();
    take_free(x_, q);
    return moved;
}

double RigidActiveSet::add_gradient(View<const Vec3> q, View<Vec3> gradient) const
{
    to_surface(q, x_);
    std::fill(field_.begin(), field_.end(), Vec3::Zero());
    const double value = surface_.add_gradient(x_, field_);
    for (int i = 0; i < free_count_; ++i)
        gradient[i] += field_[i];
    bodies_.linearise(unknowns(q), rigid_part(x_), tangent_);
    bodies_.gather(tangent_, rigid_part(field_), unknowns(gradient));
    return value;
}

bool RigidActiveSet::activate(View<const Vec3> q)
{
    to_surface(q, x_);
    if (!surface_.activate(x_))
        return false;
    bodies_.linearise(unknowns(q), rigid_part(x_), frozen_);
    const View<const Mat3> blocks = surface_.diagonal_blocks();
    std::copy_n(blocks.begin(), free_count_, blocks_.begin());
    bodies_.bound(frozen_, blocks.subview(free_count_, bodies_.vertex_count()),
                  View<Mat3>(blocks_).subview(free_count_, bodies_.unknown_count()));
    return true;
}

void RigidActiveSet::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    std::copy_n(p.begin(), free_count_, x_.begin());
    bodies_.spread(frozen_, unknowns(p), rigid_part(x_));
    std::fill(field_.begin(), field_.end(), Vec3::Zero());
    surface_.add_hessian_product(x_, field_);
    for (int i = 0; i < free_count_; ++i)
        out[i] += field_[i];
    bodies_.gather(frozen_, rigid_part(field_), unknowns(out));
}

void RigidActiveSet::append_terms(std::vector<FrozenTerm>& terms) const
{
    std::vector<FrozenTerm> of_surface;
    surface_.append_terms(of_surface);
    for (const FrozenTerm& term : of_surface) {
        FrozenTerm free;
        free.stiffness = term.stiffness;
        int count = 0;
        for (int k = 0; k < 4; ++k)
            if (term.vertex[k] >= 0 && term.vertex[k] < free_count_) {
                free.vertex[count] = term.vertex[k];
                free.weight[count++] = term.weight[k];
            }
        if (count > 0)
            terms.push_back(free);
    }
}

/// Marks free points only: bodies take implicit Euler steps.
void RigidActiveSet::mark_touching(StepField positions, View<unsigned char> touches)
{
    to_surface(positions.host(), x_);
    std::vector<unsigned char> of_surface(x_.size(), 0);
    surface_.mark_touching(StepField(x_), of_surface);
    for (int i = 0; i < free_count_; ++i)
        touches[i] |= of_surface[i];
}

bool RigidActiveSet::revise(StepField positions, MinimiserProgress progress)
{
    const View<Vec3> q = positions.change_on_host();
    to_surface(q, x_);
    const std::vector<Vec3> before = x_;
    const bool changed = surface_.revise(x_, progress);
    take_moved(before, x_, q);
    return changed;
}

void RigidActiveSet::clear(StepField positions, StepField velocities)
{
    const View<Vec3> q = positions.change_on_host(), v = velocities.change_on_host();
    to_surface(q, x_);
    const View<Vec3> velocity(field_);
    std::copy_n(v.begin(), free_count_, velocity.begin());
    bodies_.linearise(unknowns(q), rigid_part(x_), tangent_);
    bodies_.spread(tangent_, unknowns(v), rigid_part(velocity));
    surface_.clear(x_, velocity);
    take_free(x_, q);
    take_free(velocity, v);
}

bool RigidActiveSet::keep_apart(StepField positions, StepField velocities)
{
    const View<Vec3> q = positions.change_on_host(), v = velocities.change_on_host();
    to_surface(q, x_);
    const std::vector<Vec3> before = x_, wanted(q.begin(), q.end());
    std::copy_n(v.begin(), free_count_, field_.begin());
    const bool is_far = surface_.keep_apart(x_, field_);
    take_free(field_, v);
    take_moved(before, x_, q);
    for (int i = free_count_; i < q.size(); ++i)
        v[i] += (q[i] - wanted[i]) / dt_;
    return is_far;
}

/// Called after keep_apart(), whose surfaces are final.
void RigidActiveSet::end_step(StepField) { surface_.end_step(x_); }

} // namespace toile
