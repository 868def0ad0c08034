#include "collision/device_contact_terms.h"

#include <algorithm>

#include "collision/device_turns.cuh"
#include "core/backend/cuda/parallel.cuh"

namespace toile {

DeviceContactTerms::DeviceContactTerms(const CudaSpace& space, View<const Triangle> triangles,
                                       View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                       const std::vector<ContactPartner>& partners, const Settings& settings)
    : space_(space), tables_(cloths, int(partners.size()), triangles, positions), settings_(settings),
      colliders_(space, triangles, positions, partners,
                 {largest_gap(cloths), settings.face_vertex, settings.edge_edge}),
      energy_(space), memory_(space), cloth_of_(space, "terms/cloth_of"), gap_(space, "terms/gap"),
      partner_friction_(space, "terms/partner_friction"), cloth_friction_(space, "terms/cloth_friction"),
      half_thickness_(space, "terms/half_thickness"), rigid_(space, "terms/rigid"),
      altitude_(space, "terms/altitude"), room_(space, "terms/room"),
      overlap_(space, "terms/overlap", positions.size()), pair_flags_(space, "terms/pair_flags"),
      flags_(space, "terms/flags"), leans_(space, "terms/leans", positions.size()),
      list_(space, "terms/list"), turns_(space, positions.size()), push_force_(space, "terms/push_force"),
      count_(space, "terms/count", 1), limits_(space), least_(space), scratch_(space, "terms/scratch")
{
    TOILE_ASSERT(int(tables_.cloth_of.size()) == positions.size());
    cloth_of_.upload(tables_.cloth_of);
    gap_.upload(tables_.gap);
    partner_friction_.upload(tables_.partner_friction);
    cloth_friction_.upload(tables_.cloth_friction);
    rigid_.upload(tables_.rigid);
    altitude_.upload(tables_.altitude);
}

void DeviceContactTerms::begin_step(const StepStart& start)
{
    TOILE_ASSERT(start.there.x.size() == overlap_.size());
    rules_ = rules_of(start, settings_);
    rules_.cloth_of = cloth_of_.view();
    rules_.gap = gap_.view();
    rules_.partner_friction = partner_friction_.view();
    rules_.cloth_friction = cloth_friction_.view();
    rules_.x = start.there.x;
    rules_.diagonal = start.there.diagonal;
    rules_.fixed = start.there.fixed;
    push_rules_ = push_rules_of(start);
    push_rules_.fixed = start.there.fixed;
    push_rules_.masses = start.there.masses;
    push_rules_.rigid = rigid_.view();
    push_rules_.altitude = altitude_.view();
    colliders_.find(start.there.x, start.there.prediction, start.dt);
}

void DeviceContactTerms::make(const ClothContact* between)
{
    const StageScope stage("contact/make_there");
    PairsInTurn pairs{colliders_.all(), {}};
    if (between != nullptr) {
        if (half_thickness_.size() == 0)
            half_thickness_.upload(between->thickness().half);
        rules_.thickness = {half_thickness_.view()};
        pairs.second = between->pressing_there();
    }
    const int count = pairs.first.size() + pairs.second.size();
    const View<double> room = first_items(room_, pairs.first.size());
    parallel_for(space_, "contact/find_room", overlap_.size(),
                 FindRoom{colliders_.planes(), colliders_.found_at(), room, overlap_.view()});
    const View<unsigned char> flags = first_items(pair_flags_, count);
    parallel_for(space_, "contact/flag_terms", count, FlagTerm{pairs, rules_, overlap_.view(), flags});
    const int kept = list_flagged(space_, "contact/list_terms", flags, list_, count_, scratch_);
    const View<ContactTerm> terms = energy_.make_room(kept);
    parallel_for(space_, "contact/make_terms", kept,
                 MakeTerm{pairs, rules_, room, memory_.known(), list_.view(), terms});
    energy_.touch(overlap_.size());
}

FrictionLimits DeviceContactTerms::look_at_forces()
{
    return parallel_sum(space_, "contact/look_at_forces", energy_.terms().size(), FrictionLimits{},
                        LookAtForce{energy_.change_terms(), x_.there()}, limits_);
}

void DeviceContactTerms::adopt_forces()
{
    parallel_for(space_, "contact/adopt_forces", energy_.terms().size(), AdoptForce{energy_.change_terms()});
}

/// Marks the vertices of flagged terms.
void DeviceContactTerms::mark_flagged(View<unsigned char> marks)
{
    parallel_for(space_, "contact/mark_flagged", energy_.vertices().size(),
                 MarkFlagged{energy_.touches(), energy_.vertices(), flags(), marks});
}

std::vector<unsigned char> DeviceContactTerms::leaning()
{
    leans_.fill_zero();
    parallel_for(space_, "contact/flag_leaning", energy_.terms().size(),
                 FlagLeaning{look(), rules_, flags()});
    mark_flagged(leans_.view());
    return leans_.downloaded();
}

bool DeviceContactTerms::has_left(double trust)
{
    colliders_.clear_strays();
    parallel_for(space_, "contact/flag_slid", energy_.terms().size(),
                 FlagSlid{look(), rules_, colliders_.found_at(), trust, flags()});
    mark_flagged(colliders_.strays());
    return colliders_.mark_unseen(x_.there());
}

double DeviceContactTerms::deepest()
{
    const Least height =
        parallel_sum(space_, "contact/deepest", energy_.terms().size(), Least{}, LeastHeight{look()}, least_);
    return std::max(0.0, -height.value);
}

bool DeviceContactTerms::push_to_rest(int sweeps)
{
    if (empty())
        return false;
    const View<double> force = first_items(push_force_, energy_.terms().size());
    push_force_.fill_zero();
    turns_.sweep(energy_, PushToRest{push_rules_, force, x_.change_there()}, sweeps);
    return true; // as far as is known without waiting
}

void DeviceContactTerms::push_out(double most)
{
    if (empty())
        return;
    turns_.sweep(energy_, PushOut{push_rules_, most, x_.change_there()}, kClearSweeps);
}

void DeviceContactTerms::stop_at_surfaces(StepField v)
{
    if (empty())
        return;
    turns_.sweep(energy_, StopAtSurface{push_rules_, x_.there(), v.change_there()}, 1);
}

void DeviceContactTerms::rub(StepField v)
{
    if (empty())
        return;
    turns_.sweep(energy_, Rub{push_rules_, x_.change_there(), v.change_there()}, 1);
}

void DeviceContactTerms::remember(Slip slip) { memory_.keep(energy_.terms(), rules_, slip, x_.there()); }

double DeviceContactTerms::end_step()
{
    double least = 0.0;
    if (!empty())
        least = parallel_sum(space_, "contact/least_gap", energy_.terms().size(), Least{},
                             LeastDistance{look()}, least_)
                    .value;
    colliders_.learn_sides(x_.there());
    return least;
}

void DeviceContactTerms::forget()
{
    memory_.forget();
    colliders_.forget();
}

DeviceActiveSet* DeviceContactTerms::on_device([[maybe_unused]] const CudaSpace& space)
{
    TOILE_ASSERT(&space == &space_);
    return &energy_;
}

} // namespace toile
