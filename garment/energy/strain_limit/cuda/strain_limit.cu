#include "garment/energy/strain_limit/cuda/strain_limit.h"

#include <algorithm>

#include "core/compute/cuda/teams.cuh"

namespace toile::garment {

namespace {

/// Triangles per block in the search for the maximum stretch, and threads of the block.
constexpr int kChunk = 1024;
constexpr int kThreads = 256;

} // namespace

DeviceStrainLimit::DeviceStrainLimit(const CudaSpace& space)
    : space_(space), triangles_(space, "strain_limit/triangles"), rest_(space, "strain_limit/rest"),
      rest_inv_(space, "strain_limit/rest_inv"), kind_(space, "strain_limit/kind"),
      limits_(space, "strain_limit/limits"), tolerated_(space, "strain_limit/tolerated"),
      order_(space, "strain_limit/order"), cloth_(space, "strain_limit/cloth"),
      first_of_chunk_(space, "strain_limit/first_of_chunk"), first_chunk_(space, "strain_limit/first_chunk"),
      violates_(space, "strain_limit/violates"), violating_(space, "strain_limit/violating", 1),
      sums_(space, "strain_limit/sums"), violating_on_host_(space, "strain_limit/violating_on_host", 1),
      stretch_t0_(space, "strain_limit/stretch_t0"), stretch_t1_(space, "strain_limit/stretch_t1"),
      stretch_on_host_(space, "strain_limit/stretch_on_host"),
      stretch_of_chunk_(space, "strain_limit/stretch_of_chunk"), kept_(space, "strain_limit/kept"),
      forward_(space, "garment/strain_limit"), backward_(space, "garment/strain_limit")
{
}

void DeviceStrainLimit::add(const StrainLimit& limit, int first_vertex)
{
    TOILE_ASSERT(first_vertex >= int(host_.cloth.size()));
    max_sweeps_ = std::max(max_sweeps_, limit.max_sweeps());
    append(limit, first_vertex);
    upload();
}

void DeviceStrainLimit::append(const StrainLimit& limit, int first_vertex)
{
    const int first_triangle = int(host_.triangles.size()), first_kind = int(host_.limits.size());
    const LimitedTriangles triangles = limit.triangles();
    for (int t = 0; t < triangles.tri.size(); ++t) {
        host_.triangles.push_back(triangles.tri[t] + Triangle::Constant(first_vertex));
        host_.kind.push_back(first_kind + triangles.kind[t]);
    }
    host_.rest.insert(host_.rest.end(), triangles.rest.begin(), triangles.rest.end());
    host_.rest_inv.insert(host_.rest_inv.end(), triangles.rest_inv.begin(), triangles.rest_inv.end());
    host_.limits.insert(host_.limits.end(), triangles.limits.begin(), triangles.limits.end());
    host_.tolerated.push_back(triangles.limits[0].tolerated);
    if (int(host_.colours.size()) < limit.colour_count())
        host_.colours.resize(limit.colour_count());
    for (int c = 0; c < limit.colour_count(); ++c)
        for (const int t : limit.triangles_of(c))
            host_.colours[c].push_back(first_triangle + t);
    host_.cloth.resize(first_vertex, -1);
    host_.cloth.resize(first_vertex + limit.rest().vertex_count(), int(host_.first_chunk.size()) - 1);
    append_chunks(triangles.tri.size());
}

void DeviceStrainLimit::append_chunks(int triangle_count)
{
    const int end = host_.first_of_chunk.back() + triangle_count;
    while (host_.first_of_chunk.back() < end)
        host_.first_of_chunk.push_back(std::min(host_.first_of_chunk.back() + kChunk, end));
    host_.first_chunk.push_back(int(host_.first_of_chunk.size()) - 1);
}

void DeviceStrainLimit::upload()
{
    std::vector<int> order;
    first_of_colour_.assign(1, 0);
    for (const std::vector<int>& colour : host_.colours) {
        order.insert(order.end(), colour.begin(), colour.end());
        first_of_colour_.push_back(int(order.size()));
    }
    triangles_.upload(host_.triangles);
    rest_.upload(host_.rest);
    rest_inv_.upload(host_.rest_inv);
    kind_.upload(host_.kind);
    limits_.upload(host_.limits);
    tolerated_.upload(host_.tolerated);
    order_.upload(order);
    cloth_.upload(host_.cloth);
    first_of_chunk_.upload(host_.first_of_chunk);
    first_chunk_.upload(host_.first_chunk);
    violates_.resize(triangles_.size());
    stretch_t0_.resize(first_chunk_.size() - 1);
    stretch_t1_.resize(first_chunk_.size() - 1);
    stretch_on_host_.resize(first_chunk_.size() - 1);
    std::fill(stretch_on_host_.view().begin(), stretch_on_host_.view().end(), 1.0);
    stretch_of_chunk_.resize(first_of_chunk_.size() - 1);
    kept_.resize(cloth_.size());
    recorded_x_ = {};
}

LimitedTriangles DeviceStrainLimit::triangles() const
{
    return {triangles_.view(), rest_.view(), rest_inv_.view(), kind_.view(), limits_.view()};
}

CountViolating DeviceStrainLimit::count(View<const Vec3> x) { return {triangles(), x, violates_.view()}; }

/// Number of triangles that violate their limit at x.
int DeviceStrainLimit::count_violations(View<const Vec3> x)
{
    parallel_sum(space_, "strain_limit/find", triangles_.size(), 0, count(x), violating_.view(), sums_);
    return how_many();
}

/// Result of the last count. Synchronises.
int DeviceStrainLimit::how_many()
{
    violating_.download(violating_on_host_.view());
    space_.synchronise();
    return violating_on_host_[0];
}

void DeviceStrainLimit::find_largest(View<const Vec3> x, View<double> of_cloth)
{
    const std::size_t bytes = kThreads * sizeof(double);
    parallel_for_blocks<kThreads>(space_, "strain_limit/largest", stretch_of_chunk_.size(), bytes,
                                  LargestOfRange<StretchOfTriangle>{
                                      {triangles(), x}, first_of_chunk_.view(), stretch_of_chunk_.view()});
    parallel_for_blocks<kThreads>(
        space_, "strain_limit/largest_of_cloth", of_cloth.size(), bytes,
        LargestOfRange<ItemOf<double>>{{stretch_of_chunk_.view()}, first_chunk_.view(), of_cloth});
}

void DeviceStrainLimit::end_step(View<const Vec3> x)
{
    find_largest(x, stretch_t1_.view());
    stretch_t1_.download(stretch_on_host_.view());
}

double DeviceStrainLimit::max_strain() const
{
    const View<const double> stretch = stretch_on_host_.view();
    return stretch.empty() ? -1.0 : *std::max_element(stretch.begin(), stretch.end()) - 1.0;
}

void DeviceStrainLimit::project(View<Vec3> x, View<const double> inverse_masses,
                                const std::function<bool()>& clear_contacts)
{
    TOILE_ASSERT(x.size() >= cloth_.size() && inverse_masses.size() == x.size());
    TOILE_ASSERT(violating_on_host_[0] > 0);
    parallel_for(space_, "strain_limit/keep", cloth_.size(), KeepPosition{x, kept_.view()});
    find_largest(x, stretch_t0_.view());
    record(x, inverse_masses);
    sweep(x, clear_contacts);

    // Undo sweeps that end worse than they began, since they would become velocity: see StrainLimit::end.
    find_largest(x, stretch_t1_.view());
    parallel_for(space_, "strain_limit/undo", cloth_.size(),
                 UndoVertex{cloth_.view(), tolerated_.view(), stretch_t0_.view(), stretch_t1_.view(),
                            kept_.view(), x});
}

/// Sweeps until nothing violates its limit or the maximum number of sweeps is reached.
void DeviceStrainLimit::sweep(View<const Vec3> x, const std::function<bool()>& clear_contacts)
{
    int done = 0, left = violating_on_host_[0];
    while (left > 0 && done < max_sweeps_) {
        const bool clears = clear_contacts && done < StrainLimit::kSweepsWithContact;
        const int end = clears ? done + 1 : std::min(done + kSweepsAtOnce, max_sweeps_);
        for (; done < end; ++done)
            (done % 2 == 0 ? forward_ : backward_).launch();
        left = clears && clear_contacts() ? count_violations(x) : how_many();
    }
}

/// Records a sweep in either direction, unless the graphs already refer to these arrays.
void DeviceStrainLimit::record(View<Vec3> x, View<const double> inverse_masses)
{
    if (x.data() == recorded_x_.data() && inverse_masses.data() == recorded_masses_.data())
        return;
    const int colours = int(first_of_colour_.size()) - 1;
    for (const bool is_forward : {true, false})
        (is_forward ? forward_ : backward_).record([&] {
            for (int c = 0; c < colours; ++c)
                enqueue_clamp(x, inverse_masses, is_forward ? c : colours - 1 - c);
            parallel_sum(space_, "strain_limit/find", triangles_.size(), 0,
                         CountViolatingAfter{count(x), violating_.view()}, violating_.view(), sums_);
        });
    recorded_x_ = x;
    recorded_masses_ = inverse_masses;
}

void DeviceStrainLimit::enqueue_clamp(View<Vec3> x, View<const double> inverse_masses, int colour)
{
    const int first = first_of_colour_[colour], count = first_of_colour_[colour + 1] - first;
    parallel_for(space_, "strain_limit/clamp", count,
                 ClampOfColour{{triangles(), inverse_masses, x},
                               View<const int>(order_.view()).subview(first, count),
                               violates_.view(),
                               violating_.view()});
}

} // namespace toile::garment
