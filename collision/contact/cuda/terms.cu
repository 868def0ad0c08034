#include "collision/contact/cuda/terms.h"

#include <algorithm>

#include "collision/contact/cuda/gauss_seidel.cuh"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

DeviceContactTerms::DeviceContactTerms(const CudaSpace& space, View<const Triangle> triangles,
                                       View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                       const std::vector<ContactCollider>& colliders,
                                       const Settings& settings)
    : space_(space), tables_(cloths, int(colliders.size()), triangles, positions), settings_(settings),
      colliders_(space, triangles, positions, colliders,
                 {largest_gap(cloths), settings.face_vertex, settings.edge_edge}),
      energy_(space), memory_(std::make_unique<DeviceContactMemory>(space)),
      memory_of_start_(std::make_unique<DeviceContactMemory>(space)), cloth_of_(space, "terms/cloth_of"),
      gap_(space, "terms/gap"), collider_friction_(space, "terms/collider_friction"),
      cloth_friction_(space, "terms/cloth_friction"), half_thickness_(space, "terms/half_thickness"),
      rigid_(space, "terms/rigid"), altitude_(space, "terms/altitude"), clearance_(space, "terms/clearance"),
      overlap_(space, "terms/overlap", positions.size()), pair_flags_(space, "terms/pair_flags"),
      flags_(space, "terms/flags"), supported_(space, "terms/supported", positions.size()),
      list_(space, "terms/list"), gauss_seidel_(space, positions.size()),
      projection_force_(space, "terms/projection_force"), advected_(space, "terms/advected"),
      nearest_(space, "terms/nearest"), count_(space, "terms/count", 1), limits_(space), smallest_(space),
      scratch_(space, "terms/scratch")
{
    TOILE_ASSERT(int(tables_.cloth_of.size()) == positions.size());
    cloth_of_.upload(tables_.cloth_of);
    gap_.upload(tables_.gap);
    collider_friction_.upload(tables_.collider_friction);
    cloth_friction_.upload(tables_.cloth_friction);
    rigid_.upload(tables_.rigid);
    altitude_.upload(tables_.altitude);
}

View<const Vec3> DeviceContactTerms::advect(const StepStart& start)
{
    advected_.resize(start.device.x.size());
    colliders_.advect(start.device.x, start.dt);
    colliders_.download_found_at(advected_.view());
    space_.synchronise();
    return advected_.view();
}

View<const NearestSurface> DeviceContactTerms::nearest()
{
    nearest_.resize(overlap_.size());
    colliders_.download_nearest(nearest_.view());
    space_.synchronise();
    return nearest_.view();
}

void DeviceContactTerms::begin_step(const StepStart& start, View<const Vec3> carried)
{
    TOILE_ASSERT(start.device.x.size() == overlap_.size());
    has_remembered_ = false;
    energy_.use_true_hessian(start.wants_true_hessian);
    rules_ = rules_of(start, settings_);
    rules_.cloth_of = cloth_of_.view();
    rules_.gap = gap_.view();
    rules_.collider_friction = collider_friction_.view();
    rules_.cloth_friction = cloth_friction_.view();
    rules_.x = start.device.x;
    rules_.diagonal = start.device.diagonal;
    rules_.fixed = start.device.fixed;
    projection_rules_ = projection_rules_of(start);
    projection_rules_.fixed = start.device.fixed;
    projection_rules_.masses = start.device.masses;
    projection_rules_.rigid = rigid_.view();
    projection_rules_.altitude = altitude_.view();
    colliders_.find(start.device.x, start.device.prediction, start.dt, carried);
}

void DeviceContactTerms::make(const ClothContact* between)
{
    const StageScope stage("contact/make_on_device");
    ConcatenatedPairs pairs{colliders_.all(), {}};
    if (between != nullptr) {
        if (half_thickness_.size() == 0)
            half_thickness_.upload(between->thickness().half);
        rules_.thickness = {half_thickness_.view()};
        pairs.second = between->pressing_on_device();
    }
    const int count = pairs.first.size() + pairs.second.size();
    const View<double> clearance = first_items(clearance_, pairs.first.size());
    parallel_for(
        space_, "contact/find_clearance", overlap_.size(),
        FindOpposingClearance{colliders_.planes(), colliders_.found_at(), clearance, overlap_.view()});
    const View<unsigned char> flags = first_items(pair_flags_, count);
    const ReplacedPairs replaced = between != nullptr ? between->replaced() : ReplacedPairs{};
    parallel_for(space_, "contact/flag_terms", count,
                 FlagTerm{pairs, rules_, overlap_.view(), clearance, replaced, flags});
    const int kept = list_flagged(space_, "contact/list_terms", flags, list_, count_, scratch_);
    const View<ContactTerm> terms = energy_.reserve(kept);
    parallel_for(space_, "contact/make_terms", kept,
                 MakeTerm{pairs, rules_, clearance, replaced, memory_->known(), list_.view(), terms});
    energy_.build_incidence(overlap_.size());
}

TermSums DeviceContactTerms::update_forces()
{
    return parallel_sum(space_, "contact/update_forces", energy_.terms().size(), TermSums{},
                        UpdateForce{energy_.change_terms(), x_.device()}, limits_);
}

void DeviceContactTerms::adopt_forces()
{
    parallel_for(space_, "contact/adopt_forces", energy_.terms().size(), AdoptForce{energy_.change_terms()});
}

void DeviceContactTerms::update_multipliers(bool is_near)
{
    parallel_for(space_, "contact/update_multipliers", energy_.terms().size(),
                 UpdateMultiplier{energy_.change_terms(), is_near});
}

/// Marks the vertices of flagged terms.
void DeviceContactTerms::mark_flagged(View<unsigned char> marks)
{
    parallel_for(space_, "contact/mark_flagged", energy_.vertices().size(),
                 MarkFlagged{energy_.incidence(), energy_.vertices(), flags(), marks});
}

void DeviceContactTerms::mark_touching(View<unsigned char> touches)
{
    parallel_for(space_, "contact/flag_touching", energy_.terms().size(), FlagTouching{query(), flags()});
    mark_flagged(touches);
}

std::vector<unsigned char> DeviceContactTerms::supported()
{
    supported_.fill_zero();
    parallel_for(space_, "contact/flag_supported", energy_.terms().size(),
                 FlagSupported{query(), rules_, flags()});
    mark_flagged(supported_.view());
    return supported_.downloaded();
}

bool DeviceContactTerms::has_left(double trust)
{
    colliders_.clear_out_of_bounds();
    parallel_for(space_, "contact/flag_slid", energy_.terms().size(),
                 FlagSlid{query(), rules_, colliders_.found_at(), trust, flags()});
    mark_flagged(colliders_.out_of_bounds());
    return colliders_.mark_unseen(x_.device());
}

double DeviceContactTerms::deepest()
{
    const Smallest height = parallel_sum(space_, "contact/deepest", energy_.terms().size(), Smallest{},
                                         MinHeight{query()}, smallest_);
    return std::max(0.0, -height.value);
}

bool DeviceContactTerms::project_compliant(int sweeps)
{
    if (empty())
        return false;
    const View<double> force = first_items(projection_force_, energy_.terms().size());
    projection_force_.fill_zero();
    gauss_seidel_.sweep(energy_, ProjectCompliant{projection_rules_, force, x_.change_on_device()}, sweeps);
    return true; // as far as is known without waiting
}

void DeviceContactTerms::project_normal(double max_depth)
{
    if (empty())
        return;
    gauss_seidel_.sweep(energy_, ProjectNormal{projection_rules_, max_depth, x_.change_on_device()},
                        kClearSweeps);
}

void DeviceContactTerms::stop_at_surfaces(StepField v)
{
    if (empty())
        return;
    gauss_seidel_.sweep(energy_, StopAtSurface{projection_rules_, x_.device(), v.change_on_device()}, 1);
}

void DeviceContactTerms::project_friction(StepField v)
{
    if (empty())
        return;
    gauss_seidel_.sweep(energy_,
                        ProjectFriction{projection_rules_, x_.change_on_device(), v.change_on_device()}, 1);
}

void DeviceContactTerms::remember(Slip slip)
{
    if (!has_remembered_)
        std::swap(memory_, memory_of_start_);
    has_remembered_ = true;
    memory_->keep(energy_.terms(), rules_, slip, x_.device());
}

double DeviceContactTerms::end_step()
{
    double min_gap = 0.0;
    if (!empty())
        min_gap = parallel_sum(space_, "contact/min_gap", energy_.terms().size(), Smallest{},
                               MinDistance{query()}, smallest_)
                      .value;
    colliders_.update_sides(x_.device());
    return min_gap;
}

void DeviceContactTerms::abandon_step()
{
    if (has_remembered_)
        std::swap(memory_, memory_of_start_);
    has_remembered_ = false;
}

void DeviceContactTerms::forget()
{
    memory_->forget();
    memory_of_start_->forget();
    colliders_.forget();
}

DeviceActiveSet* DeviceContactTerms::on_device([[maybe_unused]] const CudaSpace& space)
{
    TOILE_ASSERT(&space == &space_);
    return &energy_;
}

} // namespace toile::collision
