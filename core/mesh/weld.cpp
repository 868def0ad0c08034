#include "core/mesh/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace toile {

namespace {

/// Vertices hashed by grid cells of one welding distance, so that matches lie in neighbouring cells.
class WeldGrid {
public:
    WeldGrid(const std::vector<Vec3>& positions, double distance)
        : positions_(positions), distance_(distance), cell_size_(std::max(distance, 1e-12))
    {
    }

    /// Lowest kept vertex within the distance of p, or -1.
    int find(const Vec3& p) const
    {
        int best = -1;
        const std::array<int64_t, 3> center = cell(p);
        for (int64_t dx = -1; dx <= 1; ++dx)
            for (int64_t dy = -1; dy <= 1; ++dy)
                for (int64_t dz = -1; dz <= 1; ++dz) {
                    const auto bucket = buckets_.find(key({center[0] + dx, center[1] + dy, center[2] + dz}));
                    if (bucket == buckets_.end())
                        continue;
                    for (const int v : bucket->second)
                        if ((positions_[v] - p).norm() <= distance_ && (best < 0 || v < best))
                            best = v;
                }
        return best;
    }

    void insert(int v) { buckets_[key(cell(positions_[v]))].push_back(v); }

private:
    std::array<int64_t, 3> cell(const Vec3& p) const
    {
        constexpr double kFarthest = 1e18; // beyond it all share a cell
        const auto index = [&](double x) {
            return int64_t(std::floor(std::clamp(x / cell_size_, -kFarthest, kFarthest)));
        };
        return {index(p.x()), index(p.y()), index(p.z())};
    }

    /// Hash of the cell's coordinates; a collision only adds candidates.
    static uint64_t key(const std::array<int64_t, 3>& c)
    {
        return uint64_t(c[0]) * 73856093u ^ uint64_t(c[1]) * 19349663u ^ uint64_t(c[2]) * 83492791u;
    }

    const std::vector<Vec3>& positions_;
    double distance_;
    double cell_size_;
    std::unordered_map<uint64_t, std::vector<int>> buckets_;
};

} // namespace

Welded weld(const TriangleMesh& mesh, double distance)
{
    Welded welded;
    welded.welded_of.resize(mesh.positions.size());
    WeldGrid grid(mesh.positions, distance);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (const int partner = grid.find(mesh.positions[v]); partner >= 0) {
            welded.welded_of[v] = welded.welded_of[partner];
            continue;
        }
        grid.insert(v);
        welded.welded_of[v] = welded.mesh.vertex_count();
        welded.source_of.push_back(v);
        welded.mesh.positions.push_back(mesh.positions[v]);
    }
    for (const Triangle& t : mesh.triangles) {
        const Triangle moved(welded.welded_of[t[0]], welded.welded_of[t[1]], welded.welded_of[t[2]]);
        if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
            welded.mesh.triangles.push_back(moved);
    }
    return welded;
}

} // namespace toile
