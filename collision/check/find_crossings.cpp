#include "collision/check/find_crossings.h"

#include <algorithm>
#include <array>

#include "collision/check/crosses.h"
#include "collision/check/crossing_box_tree.h"
#include "collision/geometry/distance.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Triangles in space, prepared for queries.
struct Soup {
    Soup(View<const Triangle> t, View<const Vec3> positions)
        : triangles(t), x(positions), boxes(t.size()), is_flat(t.size(), 0)
    {
        parallel_for(kCpu, "crossings/boxes", t.size(), [&](int i) {
            const Vec3 &a = x[t[i][0]], &b = x[t[i][1]], &c = x[t[i][2]];
            if (!a.allFinite() || !b.allFinite() || !c.allFinite())
                return; // the box stays empty and meets nothing
            for (const Vec3& corner : {a, b, c})
                boxes[i].extend(corner);
            is_flat[i] = has_no_area(a, b, c) ? 1 : 0;
        });
    }

    /// Box around all triangles that take part.
    Bounds bounds() const
    {
        Bounds all;
        for (const Bounds& box : boxes)
            if (!box.empty()) {
                all.extend(box.lower);
                all.extend(box.upper);
            }
        return all;
    }

    /// Excludes the triangles that do not reach into `region`.
    void keep_within(const Bounds& region)
    {
        for (Bounds& box : boxes)
            if (!meet(box, region))
                box = {};
    }

    View<const Triangle> triangles;
    View<const Vec3> x;
    std::vector<Bounds> boxes; ///< [triangles] empty: takes no part
    std::vector<char> is_flat;
};

/// Moves the corners common to both triangles to the front of both and returns their number.
int shared_first(Triangle& a, Triangle& b)
{
    int shared = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = shared; k < 3; ++k)
            if (a[i] == b[k]) {
                std::swap(a[shared], a[i]);
                std::swap(b[shared], b[k]);
                ++shared;
                break;
            }
    return shared;
}

TrianglePair pair_of(const Soup& soup_a, int a, const Soup& soup_b, int b, bool is_one_soup)
{
    Triangle corners_a = soup_a.triangles[a], corners_b = soup_b.triangles[b];
    TrianglePair pair;
    pair.shared = is_one_soup ? shared_first(corners_a, corners_b) : 0;
    pair.is_flat = soup_a.is_flat[a] != 0 || soup_b.is_flat[b] != 0;
    for (int k = 0; k < 3; ++k) {
        pair.a[k] = soup_a.x[corners_a[k]];
        pair.b[k] = soup_b.x[corners_b[k]];
    }
    return pair;
}

/// Point, with its distance from lying in both triangles.
struct Candidate {
    Vec3 point;
    double distance;
};

/// Appends points of triangle a's corners and edges that may lie in b: corners, crossings of b's plane, and
/// points nearest to b's edges.
void add_candidates(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, std::vector<Candidate>& out)
{
    const auto add = [&](const Vec3& p) {
        out.push_back({p, std::sqrt(closest_on_triangle(p, b[0], b[1], b[2]).distance2)});
    };
    const Vec3 normal = (b[1] - b[0]).cross(b[2] - b[0]);
    for (int i = 0; i < 3; ++i) {
        const Vec3 &p = a[i], &q = a[(i + 1) % 3];
        add(p);
        const double before = normal.dot(p - b[0]), after = normal.dot(q - b[0]);
        if ((before < 0.0) != (after < 0.0))
            add(p + before / (before - after) * (q - p));
        for (int k = 0; k < 3; ++k)
            add(p + closest_on_segments(p, q, b[k], b[(k + 1) % 3]).s * (q - p));
    }
}

/// Point of both triangles, to rounding: the mean of all candidates as good as the best. The common set is
/// convex, so the mean lies in it.
Vec3 common_point(const TrianglePair& pair)
{
    std::vector<Candidate> candidates;
    add_candidates(pair.a, pair.b, candidates);
    add_candidates(pair.b, pair.a, candidates);
    double best = candidates.front().distance, size = 0.0;
    for (const Candidate& candidate : candidates)
        best = std::min(best, candidate.distance);
    for (int k = 0; k < 3; ++k)
        size = std::max(size, (pair.a[k] - pair.a[0]).norm());
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const Candidate& candidate : candidates)
        if (candidate.distance <= best + 1e-12 * size) {
            sum += candidate.point;
            ++count;
        }
    return sum / count;
}

std::vector<Crossing> find(const Soup& soup_a, const Soup& soup_b, bool is_one_soup)
{
    const CrossingBoxTree tree(soup_b.boxes);
    std::vector<Crossing> crossings;
    parallel_append(
        kCpu, "crossings/pairs", soup_a.triangles.size(),
        [&](int begin, int end, std::vector<Crossing>& found) {
            const StandardArithmetic standard;
            std::vector<int> near;
            for (int a = begin; a < end; ++a) {
                if (soup_a.boxes[a].empty())
                    continue;
                near.clear();
                tree.find(soup_a.boxes[a], near);
                std::sort(near.begin(), near.end());
                for (const int b : near) {
                    if (is_one_soup && b <= a)
                        continue;
                    const TrianglePair pair = pair_of(soup_a, a, soup_b, b, is_one_soup);
                    if (crosses(pair))
                        found.push_back({a, b, common_point(pair)});
                }
            }
        },
        crossings);
    return crossings;
}

} // namespace

std::vector<Crossing> find_crossings(View<const Triangle> triangles, View<const Vec3> x)
{
    const StageScope stage("crossings/one_soup");
    const Soup soup(triangles, x);
    return find(soup, soup, true);
}

std::vector<Crossing> find_crossings(View<const Triangle> triangles_a, View<const Vec3> x_a,
                                     View<const Triangle> triangles_b, View<const Vec3> x_b)
{
    const StageScope stage("crossings/two_soups");
    Soup a(triangles_a, x_a), b(triangles_b, x_b);
    b.keep_within(a.bounds());
    a.keep_within(b.bounds());
    return find(a, b, false);
}

} // namespace toile::collision
