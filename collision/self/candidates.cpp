#include "collision/self/candidates.h"

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Minimum number of tasks of a search, if the tree is large enough.
constexpr int kTasks = 512;

/// Growth of the surface of the tree's boxes [-] after which it is rebuilt. Rolling over a flat,
/// axis-parallel sheet alone costs up to 2.3.
constexpr double kWornOut = 2.5;

} // namespace

Candidates::Candidates(View<const Triangle> triangles, const SurfaceEdges& edges, View<const Vec3> positions,
                       View<const int> rigid)
    : triangles_(triangles), edges_(edges), rigid_(rigid), points_(positions.size())
{
    place(positions, {}, 0.0);
    rebuild();
}

void Candidates::update(View<const unsigned char> selected, Prescribed prescribed)
{
    selected_ = selected;
    prescribed_ = prescribed;
    refit();
    if (tree_.surface(box_margin_) > kWornOut * built_surface_)
        rebuild();
    tree_.pairs_of_nodes(kTasks, tasks_);
}

/// Stores positions in single precision relative to the centre, and motions less their mean.
void Candidates::place(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    if (x.empty())
        return;
    Vec3 lower = x[0], upper = x[0];
    for (const Vec3& corner : x) {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
    }

    MovingFrame frame;
    frame.center = 0.5 * (lower + upper);
    const View<const Vec3> motion = trajectories.motion;
    is_moving_ = std::any_of(motion.begin(), motion.end(), [&](const Vec3& m) { return m != motion[0]; });
    frame.is_moving = is_moving_;
    if (is_moving_)
        frame.mean =
            parallel_sum(kCpu, motion.size(), frame.mean, [&](int v) { return motion[v]; }) / motion.size();

    parallel_for(kCpu, "collision/cloth_points", x.size(), [&](int v) {
        points_[v] = frame.point(x[v], is_moving_ ? motion[v] : frame.mean,
                                 trajectories.slack.empty() ? 0.0 : trajectories.slack[v]);
    });
    double largest = 0.0;
    for (const MovingPoint& point : points_)
        largest = std::max(largest, point.largest());
    box_margin_ = box_margin(margin, largest);
}

void Candidates::fill_leaf(int leaf)
{
    bool is_leaf_wanted = false;
    const auto fill = [&](PrimitiveBoxes::Kind& kind, const auto& vertices_of) {
        for (int b = kind.first_block[leaf]; b < kind.first_block[leaf + 1]; ++b) {
            kind.wanted[b] = 0;
            for (int lane = 0; lane < BoxBlock::kCount; ++lane) {
                const int item = kind.item_of(b, lane);
                if (item < 0)
                    continue;
                const auto vertices = vertices_of(item);
                kind.block[b].set(lane, box_of(vertices));
                if (is_wanted(vertices))
                    kind.wanted[b] |= std::uint8_t(1 << lane);
            }
            is_leaf_wanted = is_leaf_wanted || kind.wanted[b] != 0;
        }
    };
    fill(boxes_.edges, [&](int e) { return edges_.vertex[e]; });
    fill(boxes_.vertices, [&](int v) { return std::array<int, 1>{v}; });
    fill(boxes_.triangles, [&](int t) { return triangles_[t]; });
    leaf_is_wanted_[leaf] = is_leaf_wanted;

    Box all;
    for (int b = boxes_.triangles.first_block[leaf]; b < boxes_.triangles.first_block[leaf + 1]; ++b)
        all.add(boxes_.triangles.block[b].bounds());
    leaf_boxes_[leaf] = all;
}

void Candidates::refit()
{
    leaf_boxes_.resize(tree_.leaf_count());
    leaf_is_wanted_.resize(tree_.leaf_count());
    parallel_for(kCpu, "collision/cloth_refit", tree_.leaf_count(), [&](int leaf) { fill_leaf(leaf); });
    tree_.refit(leaf_boxes_, leaf_is_wanted_);
}

void Candidates::rebuild()
{
    const StageScope stage("collision/cloth_rebuild");
    std::vector<Box> items(triangles_.size());
    for (size_t t = 0; t < items.size(); ++t) {
        const Triangle& v = triangles_[t];
        items[t] = collision::box_around(0.0f, points_[v[0]], points_[v[1]], points_[v[2]]);
    }
    tree_.build(items);
    boxes_.assign(tree_, edges_, triangles_);
    refit();
    built_surface_ = tree_.surface(box_margin_);
}

} // namespace toile::collision
