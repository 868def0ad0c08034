#include "collision/body/cuda/collider_pairs.h"

#include <utility>

#include "collision/body/clearance_kernels.h"
#include "core/compute/copy_items.h"
#include "core/compute/cuda/grown_array.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

namespace {

/// Pairs per vertex of the initial capacity.
constexpr int kPairsOfVertex = 2;

} // namespace

DeviceColliderPairs::Mesh::Mesh(const CudaSpace& space, const MeshCollider& mesh, int vertex_count)
    : device_mesh(space, mesh.triangles(), mesh.x_t1()), poses(mesh.poses().on_device(space)),
      x_t0(space, "collider/x_t0", mesh.x_t1().size()), x_t1(space, "collider/x_t1"),
      x_before(space, "collider/x_before", mesh.x_t1().size()), motion(space),
      clear_at(space, "collider/clear_at", vertex_count), clearance(space, "collider/clearance", vertex_count)
{
    x_t1.upload(mesh.x_t1());
    clear_at.fill_zero();
    clearance.fill_zero();
}

/// Evaluates the poses of a mesh that has moved or stopped since. After a missed move the last motion spans
/// both moves. Waits.
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
    device_mesh.move(x_t0.view(), x_t1.view());
    if (!has_moved)
        return;
    box = device_mesh.surface().bounds();
    motion.build(device_mesh.surface().triangles(), x_before.view(), x_t1.view(), box);
}

DeviceColliderPairs::DeviceColliderPairs(const CudaSpace& space, View<const Triangle> triangles,
                                         View<const Vec3> positions,
                                         const std::vector<ContactCollider>& colliders,
                                         const ColliderPairs::Settings& settings)
    : space_(space), colliders_(colliders), settings_(settings), detector_(space, triangles, positions),
      sides_(space, positions.size()), advecting_colliders_(space, "pairs/advecting_colliders"),
      pairs_(space, "pairs/pairs", kPairsOfVertex * positions.size()),
      kept_(space, "pairs/kept", kPairsOfVertex * positions.size()), found_at_(space, "pairs/found_at"),
      reach_(space, "pairs/reach", positions.size()), wanted_(space, "pairs/wanted", positions.size()),
      nearest_(space, "pairs/nearest"), out_of_bounds_(space, "pairs/out_of_bounds", positions.size()),
      flags_(space, "pairs/flags"), list_(space, "pairs/list"), planes_(space),
      plane_pairs_(space, "pairs/planes"), first_plane_(space, "pairs/first_plane", positions.size()),
      query_bounds_(space), out_of_bounds_count_(space), count_(space, "pairs/count", 1),
      scratch_(space, "pairs/scratch")
{
    for (const ContactCollider& collider : colliders)
        meshes_.push_back(collider.mesh ? std::make_unique<Mesh>(space, *collider.mesh, positions.size())
                                        : nullptr);
    pairs_.resize(0);
    planes_.resize(kept_.size());
    plane_pairs_.resize(kept_.size());
    found_at_.upload(positions);
    reach_.fill_zero();
    out_of_bounds_.fill_zero();
    first_plane_.fill_zero();
    forget();
}

void DeviceColliderPairs::forget()
{
    nearest_.upload(std::vector<NearestSurface>(size_t(found_at_.size())));
    sides_.forget();
}

void DeviceColliderPairs::follow_colliders()
{
    std::vector<AdvectingCollider> advecting;
    for (size_t c = 0; c < colliders_.size(); ++c) {
        advecting.push_back(advecting_collider(colliders_[c]));
        if (!meshes_[c])
            continue;
        Mesh& mesh = *meshes_[c];
        mesh.follow(*colliders_[c].mesh);
        advecting.back().mesh = {mesh.device_mesh.search().surface, mesh.device_mesh.x_t0()};
        advecting.back().motion = mesh.motion.view();
    }
    advecting_colliders_.upload(advecting);
}

void DeviceColliderPairs::advect(View<const Vec3> x, double dt)
{
    max_motion_ = ColliderPairs::kMaxAdvectionSpeed * dt;
    follow_colliders();
    parallel_for(
        space_, "contact/advect", x.size(),
        AdvectVertex{advecting_colliders_.view(), nearest_.view(), x, max_motion_, found_at_.view()});
}

void DeviceColliderPairs::find(View<const Vec3> x, View<const Vec3> prediction, double dt,
                               View<const Vec3> from)
{
    if (empty())
        return;
    if (from.empty())
        advect(x, dt);
    else // after advect() in this step
        parallel_for(space_, "contact/from", x.size(), CopyItems<Vec3>{from, found_at_.view()});
    const QueryBounds bounds =
        parallel_sum(space_, "contact/reach", x.size(), QueryBounds{},
                     KeepReach{{prediction, found_at_.view(), settings_.gap}, reach_.view(), wanted_.view()},
                     query_bounds_);
    pairs_.resize(0);
    shape_radius_ = bounds.reach;
    search(found_at_.view(), &bounds);
}

void DeviceColliderPairs::find_again(View<const Vec3> x)
{
    if (empty() || !has_out_of_bounds_)
        return;
    const double distance = settings_.gap + kReachMargin;
    parallel_for(space_, "contact/query_out_of_bounds", x.size(),
                 QueryOutOfBounds{out_of_bounds_.view(), x, distance, found_at_.view(), reach_.view(),
                                  wanted_.view()});
    const View<unsigned char> flags = first_items(flags_, pairs_.size());
    parallel_for(space_, "contact/keep_pairs", pairs_.size(),
                 FlagKept{pairs_.view(), advecting_colliders_.view(), out_of_bounds_.view(), flags});
    const int kept = list_flagged(space_, "contact/list_kept", flags, list_, count_, scratch_);
    kept_.resize(kept);
    parallel_for(space_, "contact/copy_kept", kept,
                 CopyListed<ContactPair>{pairs_.view(), list_.view(), kept_.view()});
    std::swap(pairs_, kept_);
    search(x, nullptr);
}

/// Appends the pairs of vertices with a wanted reach.
/// @param bounds  of all vertices that search; null: unknown
void DeviceColliderPairs::search(View<const Vec3> x, const QueryBounds* bounds)
{
    const StageScope stage("collision/detect");
    DetectSettings settings;
    settings.radius = shape_radius_;
    settings.max_mesh_radius = kMaxReach;
    settings.max_motion = max_motion_;
    settings.face_vertex = settings_.face_vertex;
    settings.edge_edge = settings_.edge_edge;
    {
        const StageScope on_device("collision/detect_on_device");
        detector_.move(x, wanted_.view(), settings);
        for (int c = 0; c < int(colliders_.size()); ++c)
            search_collider(c, x, bounds, settings);
    }
    append(detector_.pairs());
    sort_planes();
    parallel_for(space_, "contact/take_nearest", x.size(),
                 TakeNearest{planes(), found_at_.view(), nearest_.view()});
}

/// Searches one collider; launches no search for one that is too far away.
void DeviceColliderPairs::search_collider(int c, View<const Vec3> x, const QueryBounds* bounds,
                                          const DetectSettings& settings)
{
    const bool is_far = bounds != nullptr && is_beyond(c, *bounds, settings);
    if (!meshes_[c]) {
        if (!is_far)
            detector_.detect(*colliders_[c].shape, c);
        return;
    }
    Mesh& mesh = *meshes_[c];
    follow_clearance(c, x);
    if (is_far) {
        parallel_for(space_, "collision/learn_far", x.size(),
                     UpdateFarClearance{settings.max_depth, mesh.clearance.view()});
        return;
    }
    detector_.detect(mesh.device_mesh, c, &sides_, mesh.clearance.view());
    parallel_for(space_, "collision/update_clearance", x.size(),
                 UpdateClearance{detector_.in_front().view(), mesh.clearance.view()});
}

/// True if a collider is farther from all vertices than the reach of a search.
bool DeviceColliderPairs::is_beyond(int c, const QueryBounds& bounds, const DetectSettings& settings) const
{
    constexpr double kRounding = 1e-6; // [m]
    const Vec3 middle = 0.5 * (bounds.lower + bounds.upper), half = 0.5 * (bounds.upper - bounds.lower);
    if (const ShapeCollider* const shape = colliders_[c].shape)
        return shape->closest(middle).signed_distance > half.norm() + settings.radius + kRounding;
    const Bounds& box = meshes_[c]->box;
    const Vec3 apart = (box.lower - bounds.upper).cwiseMax(bounds.lower - box.upper).cwiseMax(0.0);
    return apart.norm() > std::max(settings.mesh_radius(), settings.max_depth) + kRounding;
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
    const int now = colliders_[c].mesh->move_count();
    const FollowClearance::Mesh since = FollowClearance::since(mesh.clear_since, now);
    mesh.clear_since = now;
    parallel_for(space_, "collision/clearance", x.size(),
                 FollowClearance{x, since, mesh.motion.view(), mesh.clear_at.view(), mesh.clearance.view()});
}

bool DeviceColliderPairs::mark_unseen(View<const Vec3> x)
{
    for (int c = 0; c < int(colliders_.size()); ++c) {
        if (!meshes_[c])
            continue;
        follow_clearance(c, x);
        parallel_for(space_, "contact/mark_unseen", x.size(),
                     MarkUnseen{meshes_[c]->clearance.view(), x, found_at_.view(), reach_.view(),
                                settings_.gap, out_of_bounds_.view()});
    }
    has_out_of_bounds_ = parallel_sum(space_, "contact/count_out_of_bounds", x.size(), 0,
                                      CountOutOfBounds{out_of_bounds_.view()}, out_of_bounds_count_) > 0;
    return has_out_of_bounds_;
}

void DeviceColliderPairs::update_sides(View<const Vec3> x)
{
    for (int c = 0; c < int(colliders_.size()); ++c) {
        if (!meshes_[c] || colliders_[c].mesh->move_count() == 0)
            continue;
        follow_clearance(c, x);
        detector_.update_sides(x, meshes_[c]->device_mesh, c, sides_, meshes_[c]->clearance.view());
    }
}

} // namespace toile::collision
