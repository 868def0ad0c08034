#include "scenes/drape/seam_closing.h"

#include <algorithm>

namespace toile::scenes {

namespace {

double length(const std::array<int, 2>& thread, View<const Vec3> x)
{
    return (x[thread[0]] - x[thread[1]]).norm();
}

} // namespace

SeamClosing::SeamClosing(const GarmentMesh& mesh, std::vector<Vec3> x)
    : mesh_(mesh), closed_(mesh.panels), open_(mesh.panels.stitches), x_(std::move(x)),
      welded_gap_(open_.size(), 0.0)
{
    for (auto& seam : closed_.stitches)
        seam.clear();
    sewn_ = garment::sewn_mesh(closed_);
}

GarmentSurface SeamClosing::panels() const { return mesh_.surface(sewn_, toile::scenes::weld(sewn_, x_)); }

GarmentSurface SeamClosing::surface() const
{
    GarmentSurface surface = panels();
    for (const auto& seam : open_)
        for (const auto& [a, b] : seam)
            if (sewn_.welded_of[a] != sewn_.welded_of[b])
                surface.mesh.lines.push_back({sewn_.welded_of[a], sewn_.welded_of[b]});
    return surface;
}

void SeamClosing::move(View<const Vec3> surface) { x_ = unweld(sewn_, surface); }

int SeamClosing::weld()
{
    int count = 0;
    for (size_t s = 0; s < open_.size(); ++s) {
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
    return std::all_of(open_.begin(), open_.end(), [&](const auto& seam) {
        return std::all_of(seam.begin(), seam.end(),
                           [&](const auto& thread) { return length(thread, x_) <= kMaxGap; });
    });
}

double SeamClosing::open_length() const
{
    double sum = 0.0;
    for (const auto& seam : open_)
        for (const auto& thread : seam)
            sum += length(thread, x_);
    return sum;
}

std::vector<double> SeamClosing::gaps() const
{
    std::vector<double> gaps = welded_gap_;
    for (size_t s = 0; s < open_.size(); ++s)
        for (const auto& thread : open_[s])
            gaps[s] = std::max(gaps[s], length(thread, x_));
    return gaps;
}

} // namespace toile::scenes
