#include "collision/body/cuda/detect.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "collision/body/cuda/sides_kernels.h"
#include "core/base/error.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::collision {

namespace {

/// Initial capacity: pairs per vertex, and vertices per sheet.
constexpr int kPairsOfVertex = 3;
constexpr int kVerticesOfSheet = 16;

/// Ratio of new capacity to the number needed [-].
constexpr double kHeadroom = 1.25;

/// Threads per block of kernels with many registers.
constexpr int kBlock = 64;

int with_headroom(long needed)
{
    const long max_size = std::numeric_limits<int>::max();
    if (needed > max_size)
        throw DeviceError("collider pairs: " + std::to_string(needed) +
                          " are more than a search can hold; is the radius in metres?");
    return int(std::min(long(kHeadroom * double(needed)), max_size));
}

/// Vertices in the order of a curve through them.
std::vector<int> order_of(View<const Vec3> positions)
{
    SoupExtent extent;
    for (int v = 0; v < positions.size(); ++v)
        extent += ExtentOfVertex{positions, {}}(v);
    const SpaceCurve curve = SpaceCurve::through(extent.lower, extent.upper);
    std::vector<std::pair<std::uint64_t, int>> keys;
    for (int v = 0; v < positions.size(); ++v)
        keys.emplace_back(curve.index(positions[v]), v);
    std::sort(keys.begin(), keys.end());
    std::vector<int> order;
    for (const auto& key : keys)
        order.push_back(key.second);
    return order;
}

} // namespace

DeviceContactSideHistory::DeviceContactSideHistory(const CudaSpace& space, int vertex_count)
    : sides_(space, "sides/sides", vertex_count)
{
    forget();
}

void DeviceContactSideHistory::forget() { sides_.upload(std::vector<VertexSides>(sides_.size())); }

DeviceContactDetector::DeviceContactDetector(const CudaSpace& space, View<const Triangle> triangles,
                                             View<const Vec3> positions, int capacity)
    : space_(space), beside_(space, CudaSpace::Beside{}), begun_(space), joined_(beside_),
      cloth_(space, triangles, positions), order_(space, "detect/order"), rank_(space, "detect/rank"),
      planes_(space, "detect/planes", VertexPlanes::kMax * positions.size()),
      sheets_(space, "detect/sheets", triangles.size()),
      ridges_(space, "detect/ridges", cloth_.edges().vertex.size()), counts_(space, "detect/counts"),
      first_(space, "detect/first"), first_sheet_(space, "detect/first_sheet"),
      distance_(space, "detect/distance"), in_front_(space, "detect/in_front", positions.size()),
      sort_(space), sorted_sheets_(space, "detect/sorted_sheets"),
      sheet_capacity_(1 + positions.size() / kVerticesOfSheet), pairs_(space, "detect/pairs"),
      numbers_(space, "detect/numbers", 1), scratch_(space, "detect/scratch")
{
    order_.upload(order_of(positions));
    rank_.upload(ranks_by_corners(triangles));
    pairs_.resize(capacity > 0 ? capacity : 1 + kPairsOfVertex * positions.size());
    DeviceArray<Vec3> x(space, "detect/first_pose");
    x.upload(positions);
    cloth_.move(x.view(), {}, 0.0);
}

void DeviceContactDetector::move(View<const Vec3> x, View<const double> reach, const DetectSettings& settings)
{
    TOILE_ASSERT(x.size() == order_.size() && (reach.empty() || reach.size() == x.size()));
    x_ = x;
    reach_ = reach;
    settings_ = settings;
    count_ = 0;
}

View<const ContactPair> DeviceContactDetector::detect(const DeviceMeshCollider& mesh, int collider,
                                                      const DeviceContactSideHistory* sides,
                                                      View<const double> clearance)
{
    do
        search(mesh, collider, sides, clearance);
    while (!complete());
    return pairs_.view().subview(count_ - last_count_, last_count_);
}

void DeviceContactDetector::search(const DeviceMeshCollider& mesh, int collider,
                                   const DeviceContactSideHistory* sides, View<const double> clearance)
{
    clear_counts();
    nearest_of(collider); // creates the array before the streams fork
    begun_.record();
    begun_.delay(beside_);
    find_planes(beside_, mesh, collider, sides, clearance);
    if (settings_.edge_edge)
        find_ridges(beside_, mesh, collider);
    joined_.record();
    if (settings_.face_vertex)
        find_sheets(mesh, collider);
    joined_.delay(space_);
    report(mesh, collider);
}

bool DeviceContactDetector::complete()
{
    space_.synchronise();
    const DetectNumbers& numbers = numbers_[0];
    const long all = count_ + numbers.pairs;
    const bool had_capacity = all <= pairs_.size() && numbers.sheets <= sheet_capacity_ &&
                              numbers.max_sheets <= sheets_.capacity &&
                              numbers.max_ridges <= ridges_.capacity;
    if (had_capacity) {
        last_count_ = int(numbers.pairs);
        count_ = int(all);
        return true;
    }
    if (all > pairs_.size()) {
        const int kept = count_;
        pairs_.resize_keeping(with_headroom(all));
        count_ = kept;
    }
    if (numbers.sheets > sheet_capacity_)
        sheet_capacity_ = with_headroom(numbers.sheets);
    sheets_.capacity = std::max(sheets_.capacity, numbers.max_sheets);
    ridges_.capacity = std::max(ridges_.capacity, numbers.max_ridges);
    return false;
}

DeviceSearch DeviceContactDetector::search_of(const DeviceMeshCollider& mesh, int collider) const
{
    return {x_,
            reach_,
            mesh.search(),
            mesh.x_t0(),
            collider,
            settings_.mesh_radius(),
            settings_.max_depth,
            settings_.max_motion};
}

View<int> DeviceContactDetector::nearest_of(int collider)
{
    while (int(nearest_.size()) <= collider) {
        nearest_.push_back(std::make_unique<DeviceArray<int>>(space_, "detect/nearest"));
        nearest_.back()->upload(std::vector<int>(order_.size(), -1));
    }
    return nearest_[collider]->view();
}

/// Resizes and clears the counts; kinds that are not searched keep zero pairs.
void DeviceContactDetector::clear_counts()
{
    for (SlotArrays* slots : {&sheets_, &ridges_}) {
        slots->items.resize(slots->capacity * slots->queries);
        slots->found.resize(slots->queries + 1);
        slots->found.fill_zero();
    }
    counts_.resize(x_.size() + sheet_capacity_ + ridges_.queries + 1);
    counts_.fill_zero();
    first_.resize(counts_.size());
    first_sheet_.resize(sheets_.queries + 1);
    first_sheet_.fill_zero();
    sort_.resize(sheet_capacity_);
    sorted_sheets_.resize(sheet_capacity_);
}

void DeviceContactDetector::find_planes(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider,
                                        const DeviceContactSideHistory* sides, View<const double> clearance)
{
    parallel_for(on, "collision/device_planes", x_.size(),
                 FindPlanes{search_of(mesh, collider),
                            order_.view(),
                            sides ? sides->sides() : View<const VertexSides>(),
                            nearest_of(collider),
                            {planes_.view(), x_.size()},
                            counts_of_vertices(),
                            in_front_.view(),
                            clearance},
                 kBlock);
}

void DeviceContactDetector::find_sheets(const DeviceMeshCollider& mesh, int collider)
{
    const DeviceSearch search = search_of(mesh, collider);
    const SurfaceView cloth = toile::collision::search_of(cloth_, x_).surface;
    const ImplicitBoxTree tree = cloth_.triangle_tree();
    parallel_for(space_, "collision/device_sheets", tree.shape.count,
                 FindSheets{search, cloth, tree.nodes.subview(0, tree.shape.count), sheets_.slots(),
                            sheets_.found.view()},
                 kBlock);

    const int bits = key_bits(long(search.mesh.surface.positions.size()) * sheets_.queries);

    // Sort sheets by mesh vertex, test them, then sort them into the order of the pairs.
    const View<std::uint64_t> keys = sort_.keys.view();
    const View<int> slots = sort_.values.view();
    const View<const long> first = first_sheet_.view();
    exclusive_scan(space_, "collision/device_sheet_places", sheets_.found.view(), first_sheet_.view(),
                   scratch_);
    parallel_for(space_, "collision/device_clear_keys", keys.size(), ClearSheetKeys{keys, slots});
    parallel_for(space_, "collision/device_keys", sheets_.queries,
                 KeySheets{first, sheets_.slots(), keys, slots});
    sort_by_key(space_, "collision/device_sort_sheets", sort_, sorted_sheets_.view(), bits);
    parallel_for(space_, "collision/device_keep_sheets", sheet_capacity_,
                 KeepSheets{search, cloth, sheets_.slots(), sorted_sheets_.view(), rank_.view(),
                            counts_of_sheets(), keys, slots},
                 kBlock);
    sort_by_key(space_, "collision/device_sort_sheets", sort_, sorted_sheets_.view(), bits);
}

void DeviceContactDetector::find_ridges(const CudaSpace& on, const DeviceMeshCollider& mesh, int collider)
{
    const DeviceSearch search = search_of(mesh, collider);
    const View<const std::array<int, 2>> edge_vertex = cloth_.edges().vertex;
    const ImplicitBoxTree tree = cloth_.edge_tree();
    parallel_for(on, "collision/device_ridges", tree.shape.count,
                 FindRidges{search, tree.nodes.subview(0, tree.shape.count), edge_vertex, ridges_.slots(),
                            ridges_.found.view()},
                 kBlock);
    parallel_for(on, "collision/device_keep_ridges", ridges_.queries,
                 KeepRidges{search, edge_vertex, ridges_.found.view(), ridges_.slots(), counts_of_ridges()},
                 kBlock);
}

/// Maximum number of candidates that a query has found, before the test for pairs.
void DeviceContactDetector::measure(SlotArrays& slots)
{
    parallel_sum(space_, "collision/device_max", slots.queries, Largest(), MaxOf{slots.found.view()},
                 slots.max_found.view(), slots.sums);
}

void DeviceContactDetector::report(const DeviceMeshCollider& mesh, int collider)
{
    exclusive_scan(space_, "collision/device_slots", counts_.view(), first_.view(), scratch_);
    measure(sheets_);
    measure(ridges_);
    const View<const long> first_sheet = first_sheet_.view();
    parallel_for(space_, "collision/device_detect_numbers", 1,
                 CollectDetectNumbers{pair_slots(), first_sheet.subview(sheets_.queries, 1),
                                      sheets_.max_found.view(), ridges_.max_found.view(), numbers_.view()});

    const DeviceSearch search = search_of(mesh, collider);
    const View<ContactPair> pairs = pairs_.view().subview(count_, pairs_.size() - count_);
    parallel_for(space_, "collision/device_report_planes", x_.size(),
                 ReportPlanes{search, counts_of_vertices(), {planes_.view(), x_.size()}, pair_slots(), pairs},
                 kBlock);
    parallel_for(space_, "collision/device_report_sheets", settings_.face_vertex ? sheet_capacity_ : 0,
                 ReportSheet{search, toile::collision::search_of(cloth_, x_).surface, sorted_sheets_.view(),
                             sheets_.slots(), pair_slots(), pairs},
                 kBlock);
    parallel_for(
        space_, "collision/device_report_ridges", ridges_.found.size(),
        ReportRidges{search, cloth_.edges().vertex, counts_of_ridges(), ridges_.slots(), pair_slots(), pairs},
        kBlock);
}

void DeviceContactDetector::update_sides(View<const Vec3> x, const DeviceMeshCollider& mesh, int collider,
                                         DeviceContactSideHistory& sides, View<const double> clearance)
{
    TOILE_ASSERT(x.size() == order_.size());
    parallel_for(space_, "collision/device_learn_sides", x.size(),
                 UpdateSides{x, mesh.search(), collider, order_.view(), nearest_of(collider), sides.sides(),
                             clearance},
                 kBlock);
}

} // namespace toile::collision
