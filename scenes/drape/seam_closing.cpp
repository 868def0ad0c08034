#include "scenes/drape/seam_closing.h"

#include <algorithm>

#include "scenes/drape/notions.h"

namespace toile::scenes {

namespace {

double length(const std::array<int, 2>& thread, View<const Vec3> x)
{
    return (x[thread[0]] - x[thread[1]]).norm();
}

double longest(const std::vector<std::array<int, 2>>& threads, View<const Vec3> x)
{
    double most = 0.0;
    for (const auto& thread : threads)
        most = std::max(most, length(thread, x));
    return most;
}

bool is_of_one_panel(const garment::Seam& seam)
{
    const auto is_on_it = [&](const garment::EdgePart& part) { return part.panel == seam.a[0].panel; };
    return std::all_of(seam.a.begin(), seam.a.end(), is_on_it) &&
           std::all_of(seam.b.begin(), seam.b.end(), is_on_it);
}

} // namespace

SeamClosing::SeamClosing(const GarmentMesh& mesh, std::vector<Vec3> x, std::vector<int> order)
    : mesh_(mesh), order_(std::move(order)), closed_(mesh.panels), open_(mesh.panels.stitches),
      x_(std::move(x)), welded_gap_(open_.size(), 0.0)
{
    order_.resize(open_.size(), 0);
    for (auto& seam : closed_.stitches)
        seam.clear();
    sewn_ = garment::sewn_mesh(closed_);
}

std::vector<size_t> SeamClosing::active() const
{
    std::vector<size_t> seams;
    for (size_t s = 0; s < open_.size(); ++s) {
        if (open_[s].empty() || (!seams.empty() && order_[s] > order_[seams[0]]))
            continue;
        if (!seams.empty() && order_[s] < order_[seams[0]])
            seams.clear();
        seams.push_back(s);
    }
    return seams;
}

GarmentSurface SeamClosing::panels() const { return mesh_.surface(sewn_, toile::scenes::weld(sewn_, x_)); }

GarmentSurface SeamClosing::surface() const
{
    GarmentSurface surface = panels();
    for (const size_t s : active())
        for (const auto& [a, b] : open_[s])
            if (sewn_.welded_of[a] != sewn_.welded_of[b])
                surface.mesh.lines.push_back({sewn_.welded_of[a], sewn_.welded_of[b]});
    return surface;
}

std::vector<scene::Tack> SeamClosing::tacks(const garment::Pattern& pattern) const
{
    return tacks_of(pattern, mesh_.panels, sewn_);
}

void SeamClosing::move(View<const Vec3> surface) { x_ = unweld(sewn_, surface); }

int SeamClosing::weld()
{
    int count = 0;
    for (const size_t s : active()) {
        const auto first_short =
            std::stable_partition(open_[s].begin(), open_[s].end(),
                                  [&](const auto& thread) { return length(thread, x_) > kMaxGap; });
        for (auto thread = first_short; thread != open_[s].end(); ++thread) {
            welded_gap_[s] = std::max(welded_gap_[s], length(*thread, x_));
            closed_.stitches[s].push_back(*thread);
            ++count;
        }
        open_[s].erase(first_short, open_[s].end());
    }
    sewn_ = garment::sewn_mesh(closed_);
    x_ = unweld(sewn_, toile::scenes::weld(sewn_, x_));
    return count;
}

bool SeamClosing::are_closed() const
{
    return std::all_of(open_.begin(), open_.end(), [](const auto& seam) { return seam.empty(); });
}

bool SeamClosing::can_weld() const
{
    for (const size_t s : active())
        if (longest(open_[s], x_) > kMaxGap)
            return false;
    return true;
}

double SeamClosing::open_length() const
{
    double sum = 0.0;
    for (const size_t s : active())
        for (const auto& thread : open_[s])
            sum += length(thread, x_);
    return sum;
}

int SeamClosing::widest() const
{
    int widest = -1;
    double most = -1.0;
    for (const size_t s : active())
        if (const double gap = longest(open_[s], x_); gap > most) {
            most = gap;
            widest = int(s);
        }
    return widest;
}

std::vector<double> SeamClosing::gaps() const
{
    std::vector<double> gaps = welded_gap_;
    for (size_t s = 0; s < open_.size(); ++s)
        gaps[s] = std::max(gaps[s], longest(open_[s], x_));
    return gaps;
}

std::vector<int> orders_of(const garment::Pattern& pattern)
{
    std::vector<int> orders;
    for (const garment::Seam& seam : pattern.seams)
        orders.push_back(2 * seam.order + (is_of_one_panel(seam) ? 0 : 1));
    return orders;
}

} // namespace toile::scenes
