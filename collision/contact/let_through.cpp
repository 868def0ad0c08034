#include "collision/contact/let_through.h"

#include <algorithm>
#include <numeric>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Distance from its owner [m] beyond which cloth may be dressed on a surface that opposes it.
constexpr double kLeft = 0.01;

/// Excess of vertices with owners on one side over those on the other [-] from which on a patch is of one
/// side.
constexpr double kOneSided = 0.6;

/// Distance of cloth on one part from cloth on the other in an overlap [m].
constexpr double kBetween = 0.015;

int root_of(std::vector<int>& parent, int v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

} // namespace

LetThrough::LetThrough(const BodySurfaces& bodies, View<const Triangle> triangles, int vertices, double room)
    : bodies_(bodies), room_(room), triangles_(triangles.begin(), triangles.end()), owner_(vertices),
      released_(vertices, 0), owner_normal_(vertices, Vec3::Zero())
{
    neighbours_.resize(vertices);
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            for (const int other : {t[(k + 1) % 3], t[(k + 2) % 3]})
                neighbours_[t[k]].push_back(other);
}

void LetThrough::begin_step(View<const Vec3> x, View<const NearestSurface> nearest)
{
    x_.assign(x.begin(), x.end());
    parallel_for(kCpu, "collision/owners", x.size(), [&](int v) { walk(v, x[v], nearest[v]); });
    if (bodies_.is_moving() || bodies_.has_jumped())
        has_normals_ = false;
}

View<const Vec3> LetThrough::body_normal()
{
    if (!has_normals_) {
        std::vector<Vec3> x(bodies_.vertex_count());
        bodies_.pose_t1(x);
        body_normal_ = vertex_normals(x, bodies_.triangles());
        has_normals_ = true;
    }
    return body_normal_;
}

/// The owner moves on to the nearest surface, but not to one that faces elsewhere while it is near itself.
void LetThrough::walk(int v, const Vec3& x, const NearestSurface& nearest)
{
    NearestSurface& owner = owner_[v];
    if (nearest.collider >= 0) {
        const bool is_other =
            owner.collider >= 0 && bodies_.normal_at(nearest, x).dot(bodies_.normal_at(owner, x)) < kOwnSheet;
        if (!is_other || (released_[v] == 0 && bodies_.distance_to(owner, x) > kLeft))
            owner = nearest;
    }
    if (owner.collider >= 0)
        owner_normal_[v] = bodies_.normal_at(owner, x);
}

bool LetThrough::release(View<const int> vertices, bool is_last_resort)
{
    std::vector<int> added;
    for (const int v : vertices)
        if (owner_[v].collider >= 0 && released_[v] == 0) {
            released_[v] = kLetsOpposing;
            added.push_back(v);
        }
    if (added.empty()) {
        bool changes = false;
        for (const int v : vertices)
            if (is_last_resort && released_[v] == kLetsOpposing) {
                released_[v] = kLetsAll;
                changes = true;
            }
        return changes;
    }
    count_ += int(added.size());
    std::vector<unsigned char> is_seen(released_.size(), 0);
    std::vector<int> patch;
    for (const int seed : added) {
        if (is_seen[seed] != 0)
            continue;
        patch.assign(1, seed);
        is_seen[seed] = 1;
        for (size_t i = 0; i < patch.size(); ++i)
            for (const int v : neighbours_[patch[i]])
                if (released_[v] != 0 && is_seen[v] == 0) {
                    is_seen[v] = 1;
                    patch.push_back(v);
                }
        agree(patch);
    }
    return !added.empty();
}

/// Gives a connected patch owners on one side, that of most of its vertices, if few are on the other: these
/// take the owner of a neighbour.
void LetThrough::agree(View<const int> patch)
{
    const Vec3 reference = owner_normal_[patch[0]];
    int ahead = 0;
    for (const int v : patch)
        ahead += owner_normal_[v].dot(reference) >= 0.0 ? 1 : -1;
    if (std::abs(ahead) < kOneSided * patch.size() && is_between(patch)) {
        for (const int v : patch)
            released_[v] = kLetsAll;
        return;
    }
    const double side = ahead >= 0 ? 1.0 : -1.0;
    const auto agrees = [&](int v) { return side * owner_normal_[v].dot(reference) >= 0.0; };
    for (bool goes_on = true; goes_on;) {
        goes_on = false;
        for (const int v : patch) {
            if (agrees(v))
                continue;
            const auto model = std::find_if(neighbours_[v].begin(), neighbours_[v].end(),
                                            [&](int n) { return released_[n] != 0 && agrees(n); });
            if (model == neighbours_[v].end())
                continue;
            owner_[v] = owner_[*model];
            owner_normal_[v] = owner_normal_[*model];
            goes_on = true;
        }
    }
}

/// True if cloth of a patch lies near, or beside, other cloth of it whose owner is on the other side. Around
/// a limb it does not.
bool LetThrough::is_between(View<const int> patch) const
{
    const auto are_opposite = [&](int v, int w) {
        return owner_normal_[v].dot(owner_normal_[w]) < -kOwnSheet;
    };
    return std::any_of(patch.begin(), patch.end(), [&](int v) {
        return std::any_of(neighbours_[v].begin(), neighbours_[v].end(),
                           [&](int w) { return is_released(w) && are_opposite(v, w); }) ||
               std::any_of(patch.begin(), patch.end(),
                           [&](int w) { return are_opposite(v, w) && (x_[v] - x_[w]).norm() < kBetween; });
    });
}

void LetThrough::close(View<const int> crossing)
{
    if (count_ == 0)
        return;
    std::vector<int> parent(released_.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (const Triangle& t : triangles_)
        for (int k = 0; k < 3; ++k)
            if (is_released(t[k]) && is_released(t[(k + 1) % 3]))
                parent[root_of(parent, t[k])] = root_of(parent, t[(k + 1) % 3]);
    std::vector<unsigned char> crosses(released_.size(), 0);
    for (const int t : crossing)
        for (const int v : triangles_[t])
            if (is_released(v))
                crosses[root_of(parent, v)] = 1;
    count_ = 0;
    for (int v = 0; v < int(released_.size()); ++v) {
        if (crosses[root_of(parent, v)] == 0)
            released_[v] = 0;
        count_ += is_released(v) ? 1 : 0;
    }
}

void LetThrough::forget()
{
    std::fill(owner_.begin(), owner_.end(), NearestSurface{});
    std::fill(released_.begin(), released_.end(), 0);
    count_ = 0;
}

} // namespace toile::collision
