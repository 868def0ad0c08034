#include "collision/device_collider_pairs.h"

#include <utility>

#include "collision/clearance_kernels.h"
#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/roomy.h"

namespace toile {

namespace {

/// Room at first.
constexpr int kPairsOfVertex = 2;

} // namespace

DeviceColliderPairs::Mesh::Mesh(const CudaSpace& space, const MeshCollider& mesh, int vertex_count)
    : there(space, mesh.triangles(), mesh.x_t1()), poses(mesh.poses().on_device(space)),
      x_t0(space, "collider/x_t0", mesh.x_t1().size()), x_t1(space, "collider/x_t1"),
      x_before(space, "collider/x_before", mesh.x_t1().size()), motion(space),
      clear_at(space, "collider/clear_at", vertex_count), clearance(space, "collider/clearance", vertex_count)
{
    x_t1.upload(mesh.x_t1());
    clear_at.fill_zero();
    clearance.fill_zero();
}

/// Poses a mesh where it has moved, or stopped, since. Who misses a move has the motion of both. Waits.
void DeviceColliderPairs::Mesh::follow(const MeshCollider& mesh)
{
    const Step now{mesh.move_count(), mesh.is_moving()};
    if (placed_at == now)
        return;
    const bool has_moved = now.move_count > placed_at.move_count;
    placed_at = now;
    poses->pose_t0(x_t0);
    if (has_moved) {
        std::swap(x_before, x_t1);
        poses->pose_t1(x_t1);
    }
    there.move(x_t0.view(), x_t1.view());
    if (!has_moved)
        return;
    box = there.surface().bounds();
    motion.build(there.surface().triangles(), x_before.view(), x_t1.view(), box);
}

DeviceColliderPairs::DeviceColliderPairs(const CudaSpace& space, View<const Triangle> triangles,
                                         View<const Vec3> positions,
                                         const std::vector<ContactPartner>& partners,
                                         const ColliderPairs::Settings& settings)
    : space_(space), partners_(partners), settings_(settings), detector_(space, triangles, positions),
      sides_(space, positions.size()), carrying_(space, "pairs/carrying"),
      pairs_(space, "pairs/pairs", kPairsOfVertex * positions.size()),
      kept_(space, "pairs/kept", kPairsOfVertex * positions.size()), found_at_(space, "pairs/found_at"),
      reach_(space, "pairs/reach", positions.size()), wanted_(space, "pairs/wanted", positions.size()),
      nearest_(space, "pairs/nearest"), strays_(space, "pairs/strays", positions.size()),
      flags_(space, "pairs/flags"), list_(space, "pairs/list"), planes_(space),
      plane_pairs_(space, "pairs/planes"), first_plane_(space, "pairs/first_plane", positions.size()),
      surroundings_(space), stray_count_(space), count_(space, "pairs/count", 1),
      scratch_(space, "pairs/scratch")
{
    for (const ContactPartner& partner : partners)
        meshes_.push_back(partner.mesh ? std::make_unique<Mesh>(space, *partner.mesh, positions.size())
                                       : nullptr);
    pairs_.resize(0);
    planes_.resize(kept_.size());
    plane_pairs_.resize(kept_.size());
    found_at_.upload(positions);
    reach_.fill_zero();
    strays_.fill_zero();
    first_plane_.fill_zero();
    forget();
}

void DeviceColliderPairs::forget()
{
    nearest_.upload(std::vector<NearestSurface>(size_t(found_at_.size())));
    sides_.forget();
}

void DeviceColliderPairs::follow_partners()
{
    std::vector<CarryingPartner> carrying;
    for (size_t c = 0; c < partners_.size(); ++c) {
        carrying.push_back(toile::carrying(partners_[c]));
        if (!meshes_[c])
            continue;
        Mesh& mesh = *meshes_[c];
        mesh.follow(*partners_[c].mesh);
        carrying.back().mesh = {mesh.there.search().surface, mesh.there.x_t0()};
        carrying.back().motion = mesh.motion.view();
    }
    carrying_.upload(carrying);
}

void DeviceColliderPairs::find(View<const Vec3> x, View<const Vec3> prediction, double dt)
{
    if (empty())
        return;
    farthest_motion_ = ColliderPairs::kMaxCarrySpeed * dt;
    follow_partners();
    parallel_for(space_, "contact/carry", x.size(),
                 CarryVertex{carrying_.view(), nearest_.view(), x, farthest_motion_, found_at_.view()});
    const Surroundings around =
        parallel_sum(space_, "contact/reach", x.size(), Surroundings{},
                     KeepReach{{prediction, found_at_.view(), settings_.gap}, reach_.view(), wanted_.view()},
                     surroundings_);
    pairs_.resize(0);
    look(found_at_.view(), around.reach, &around);
}

void DeviceColliderPairs::find_again(View<const Vec3> x)
{
    if (empty() || !has_strays_)
        return;
    const double distance = settings_.gap + kReachMargin;
    parallel_for(space_, "contact/want_strays", x.size(),
                 WantStray{strays_.view(), x, distance, found_at_.view(), reach_.view(), wanted_.view()});
    const View<unsigned char> flags = first_items(flags_, pairs_.size());
    parallel_for(space_, "contact/keep_pairs", pairs_.size(),
                 FlagKept{pairs_.view(), carrying_.view(), strays_.view(), flags});
    const int kept = list_flagged(space_, "contact/list_kept", flags, list_, count_, scratch_);
    kept_.resize(kept);
    parallel_for(space_, "contact/copy_kept", kept,
                 CopyListed<ContactPair>{pairs_.view(), list_.view(), kept_.view()});
    std::swap(pairs_, kept_);
    look(x, distance, nullptr);
}

/// Adds the pairs that are wanted.
/// @param around  of all vertices that look; null: not known
void DeviceColliderPairs::look(View<const Vec3> x, double radius, const Surroundings* around)
{
    const StageScope stage("collision/detect");
    DetectSettings settings;
    settings.radius = radius;
    settings.farthest_motion = farthest_motion_;
    settings.face_vertex = settings_.face_vertex;
    settings.edge_edge = settings_.edge_edge;
    {
        const StageScope there("collision/detect_there");
        detector_.move(x, wanted_.view(), settings);
        for (int c = 0; c < int(partners_.size()); ++c)
            look_at(c, x, around, settings);
    }
    append(detector_.pairs());
    sort_planes();
    parallel_for(space_, "contact/take_nearest", x.size(),
                 TakeNearest{planes(), found_at_.view(), nearest_.view()});
}

/// The same of one partner; nothing is launched for one that is too far away.
void DeviceColliderPairs::look_at(int c, View<const Vec3> x, const Surroundings* around,
                                  const DetectSettings& settings)
{
    const bool is_far = around != nullptr && is_beyond(c, *around, settings);
    if (!meshes_[c]) {
        if (!is_far)
            detector_.detect(*partners_[c].shape, c);
        return;
    }
    Mesh& mesh = *meshes_[c];
    follow_clearance(c, x);
    if (is_far) {
        parallel_for(space_, "collision/learn_far", x.size(),
                     LearnFar{settings.max_depth, mesh.clearance.view()});
        return;
    }
    detector_.detect(mesh.there, c, &sides_, mesh.clearance.view());
    parallel_for(space_, "collision/learn_clearance", x.size(),
                 LearnClearance{detector_.in_front().view(), mesh.clearance.view()});
}

/// True where a partner is farther from all of the vertices than a search looks for it.
bool DeviceColliderPairs::is_beyond(int c, const Surroundings& around, const DetectSettings& settings) const
{
    constexpr double kRounding = 1e-6; // [m]
    const Vec3 middle = 0.5 * (around.lower + around.upper), half = 0.5 * (around.upper - around.lower);
    if (const ShapeCollider* const shape = partners_[c].shape)
        return shape->closest(middle).signed_distance > half.norm() + settings.radius + kRounding;
    const Bounds& box = meshes_[c]->box;
    const Vec3 apart = (box.lower - around.upper).cwiseMax(around.lower - box.upper).cwiseMax(0.0);
    return apart.norm() > std::max(settings.radius, settings.max_depth) + kRounding;
}

void DeviceColliderPairs::append(View<const ContactPair> found)
{
    const int before = pairs_.size();
    pairs_.resize_keeping(before + found.size());
    parallel_for(space_, "contact/append_pairs", found.size(),
                 CopyItems<ContactPair>{found, pairs_.view().subview(before, found.size())});
}

void DeviceColliderPairs::sort_planes()
{
    const int count = pairs_.size();
    planes_.resize(count);
    plane_pairs_.resize(count);
    parallel_for(space_, "contact/key_planes", count,
                 KeyPlane{pairs_.view(), planes_.keys.view(), planes_.values.view()});
    sort_by_key(space_, "contact/sort_planes", planes_, plane_pairs_.view(), key_bits(first_plane_.size()));
    first_plane_.fill_zero();
    parallel_for(space_, "contact/begin_planes", count,
                 BeginPlanes{planes_.sorted_keys.view(), first_plane_.view()});
}

PlanesOfVertices DeviceColliderPairs::planes() const
{
    return {pairs_.view(), first_plane_.view(), planes_.sorted_keys.view(), plane_pairs_.view()};
}

void DeviceColliderPairs::follow_clearance(int c, View<const Vec3> x)
{
    Mesh& mesh = *meshes_[c];
    const int now = partners_[c].mesh->move_count();
    const FollowClearance::Mesh since = FollowClearance::since(mesh.clear_since, now);
    mesh.clear_since = now;
    parallel_for(space_, "collision/clearance", x.size(),
                 FollowClearance{x, since, mesh.motion.view(), mesh.clear_at.view(), mesh.clearance.view()});
}

bool DeviceColliderPairs::mark_unseen(View<const Vec3> x)
{
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (!meshes_[c])
            continue;
        follow_clearance(c, x);
        parallel_for(space_, "contact/mark_unseen", x.size(),
                     MarkUnseen{meshes_[c]->clearance.view(), x, found_at_.view(), reach_.view(),
                                settings_.gap, strays_.view()});
    }
    has_strays_ = parallel_sum(space_, "contact/count_strays", x.size(), 0, CountStray{strays_.view()},
                               stray_count_) > 0;
    return has_strays_;
}

void DeviceColliderPairs::learn_sides(View<const Vec3> x)
{
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (!meshes_[c] || partners_[c].mesh->move_count() == 0)
            continue;
        follow_clearance(c, x);
        detector_.learn_sides(x, meshes_[c]->there, c, sides_, meshes_[c]->clearance.view());
    }
}

} // namespace toile
