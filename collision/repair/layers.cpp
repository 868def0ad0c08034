#include "collision/repair/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "collision/check/find_crossings.h"
#include "collision/repair/body_clearing.h"
#include "collision/repair/edge_triangle_intersections.h"
#include "collision/repair/untangle_cloth.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Depth below a lower layer [m] up to which a vertex counts as touching it.
constexpr double kTouching = 1e-6;

/// Layer of a vertex among those of the pieces.
int layer_of(const JoinedCloths& cloths, const std::vector<int>& layers, int vertex)
{
    return cloths.piece[vertex] < 0 ? 0 : layers[cloths.piece[vertex]];
}
int layer_of(const JoinedCloths& cloths, int vertex) { return layer_of(cloths, cloths.layer, vertex); }

/// Layers that cross a lower one, or lie under it. If none crosses, those that touch it.
std::set<int> misplaced_layers(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies,
                               View<const Vec3> x)
{
    std::set<int> layers;
    if (std::set<int>(cloths.layer.begin(), cloths.layer.end()).size() < 2)
        return layers;
    const auto add = [&](int vertex_a, int vertex_b) {
        const int a = layer_of(cloths, vertex_a), b = layer_of(cloths, vertex_b);
        if (a != b)
            layers.insert(std::max(a, b));
    };
    for (const EdgeTriangleIntersection& intersection : find_edge_triangle_intersections(cloths, x))
        add(cloths.edges.vertex[intersection.edge][0], cloths.triangles[intersection.triangle][0]);
    if (layers.empty())
        for (const Crossing& crossing : find_crossings(cloths.triangles, x))
            add(cloths.triangles[crossing.a][0], cloths.triangles[crossing.b][0]);
    for (const UnderLayer& under : find_under_layers(cloths, bodies, x))
        layers.insert(cloths.layer[under.piece]);
    return layers;
}

/// [pieces] Volume that a closed piece encloses, negative inside out [m^3]; 0 for others.
std::vector<double> enclosed_volumes(const JoinedCloths& cloths, View<const Vec3> x)
{
    std::vector<double> volume(cloths.piece_count(), 0.0);
    std::vector<int> origin(cloths.piece_count(), -1); // a vertex of the piece
    for (const Triangle& t : cloths.triangles) {
        const int piece = cloths.piece[t[0]];
        if (origin[piece] < 0)
            origin[piece] = t[0];
        const Vec3& o = x[origin[piece]];
        volume[piece] += (x[t[0]] - o).dot((x[t[1]] - o).cross(x[t[2]] - o)) / 6.0;
    }
    for (int e = 0; e < cloths.edges.edge_count(); ++e)
        if (cloths.edges.triangles.of(e).size() != 2)
            volume[cloths.piece[cloths.edges.vertex[e][0]]] = 0.0;
    return volume;
}

/// [pieces] Nonzero if the winding of the triangles faces the bodies, or the inside of a closed piece.
std::vector<char> pieces_inside_out(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies,
                                    View<const Vec3> x)
{
    std::vector<double> agreement(cloths.piece_count(), 0.0), of_triangle(cloths.triangles.size(), 0.0);
    parallel_for(kCpu, "untangle/layers", int(cloths.triangles.size()), [&](int t) {
        const Triangle& corner = cloths.triangles[t];
        const Vec3 doubled_area = (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]);
        const Vec3 centroid = (x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0;
        if (const auto proximity = nearest_body(bodies, centroid, kMaxStartDepth))
            of_triangle[t] = doubled_area.dot(proximity->normal);
    });
    for (size_t t = 0; t < of_triangle.size(); ++t)
        agreement[cloths.piece[cloths.triangles[t][0]]] += of_triangle[t];
    const std::vector<double> volume = enclosed_volumes(cloths, x);
    std::vector<char> inside_out(agreement.size());
    std::transform(
        agreement.begin(), agreement.end(), volume.begin(), inside_out.begin(),
        [](double sum, double enclosed) { return char((enclosed != 0.0 ? enclosed : sum) < 0.0); });
    return inside_out;
}

/// Cloth below a layer, as a mesh that acts as a body. @param layers  [pieces]
MovingMesh below(const JoinedCloths& cloths, const std::vector<int>& layers, int layer,
                 const std::vector<char>& inside_out, View<const Vec3> x)
{
    MovingMesh mesh;
    for (const Triangle& corner : cloths.triangles)
        if (layer_of(cloths, layers, corner[0]) < layer)
            mesh.triangles.push_back(inside_out[cloths.piece[corner[0]]] != 0
                                         ? Triangle(corner[0], corner[2], corner[1])
                                         : corner);
    mesh.x_t0.assign(x.begin(), x.end());
    mesh.x_t1 = mesh.x_t0;
    return mesh;
}

} // namespace

bool separate_layers(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies, View<Vec3> x,
                     const RepairProgress& progress)
{
    const std::set<int> layers = misplaced_layers(cloths, bodies, x);
    if (layers.empty())
        return false;
    const std::vector<char> inside_out = pieces_inside_out(cloths, bodies, x);
    double done = 0.0;
    for (const int layer : layers) {
        const RepairProgress of_layer =
            progress.part(done / double(layers.size()), (done + 1.0) / double(layers.size()));
        done += 1.0;
        JoinedCloths upper = cloths;
        for (int v = 0; v < cloths.vertex_count(); ++v) {
            upper.fixed[v] = char(cloths.fixed[v] != 0 || layer_of(cloths, v) != layer);
            upper.gap[v] = cloths.thickness[v];
        }
        const MeshCollider lower(below(cloths, cloths.layer, layer, inside_out, x));
        const BodyClearing clearing(upper, {{&lower, nullptr}});
        clearing.grow(x, ShapeKeeper(upper), of_layer);
        clear_crossings(upper, clearing, x);
    }
    return true;
}

std::vector<UnderLayer> find_under_layers(const JoinedCloths& cloths,
                                          const std::vector<ContactCollider>& bodies, View<const Vec3> x)
{
    std::vector<UnderLayer> found;
    std::set<int> layers(cloths.given_layer.begin(), cloths.given_layer.end());
    if (layers.size() < 2 || bodies.empty())
        return found;
    layers.erase(layers.begin());
    const std::vector<char> inside_out = pieces_inside_out(cloths, bodies, x);
    struct Tally {
        int under = 0, over = 0;
        UnderLayer deepest{-1, -1, -1, kTouching};
    };
    std::vector<Tally> tallies(cloths.piece_count());
    for (const int layer : layers) {
        const MeshCollider lower(below(cloths, cloths.given_layer, layer, inside_out, x));
        const std::vector<ContactCollider> lower_cloth{{&lower, nullptr}};
        std::vector<double> depth(cloths.vertex_count(), -std::numeric_limits<double>::infinity());
        parallel_for(kCpu, "untangle/layers", cloths.vertex_count(), [&](int v) {
            if (layer_of(cloths, cloths.given_layer, v) != layer ||
                !nearest_body(bodies, x[v], kMaxStartDepth))
                return;
            if (const auto proximity = nearest_body(lower_cloth, x[v], kMaxStartDepth))
                depth[v] = -proximity->signed_distance;
        });
        for (int v = 0; v < cloths.vertex_count(); ++v) {
            if (!std::isfinite(depth[v]) || cloths.piece[v] < 0)
                continue;
            Tally& tally = tallies[cloths.piece[v]];
            (depth[v] > kTouching ? tally.under : tally.over) += 1;
            if (depth[v] > tally.deepest.depth)
                tally.deepest = {cloths.piece[v], v,
                                 lower.triangles()[lower.surface().closest(x[v])->triangle][0], depth[v]};
        }
    }
    for (const Tally& tally : tallies)
        if (tally.under > tally.over)
            found.push_back(tally.deepest);
    return found;
}

std::vector<int> layers_without_ties(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies)
{
    std::vector<double> sum(cloths.piece_count(), 0.0);
    std::vector<int> count(cloths.piece_count(), 0);
    for (int v = 0; v < cloths.vertex_count(); ++v)
        if (const auto proximity = nearest_body(bodies, cloths.start[v], kMaxStartDepth);
            proximity && cloths.piece[v] >= 0) {
            sum[cloths.piece[v]] += proximity->signed_distance;
            ++count[cloths.piece[v]];
        }
    std::vector<std::tuple<int, double, int>> order;
    order.reserve(cloths.layer.size());
    for (int p = 0; p < cloths.piece_count(); ++p)
        order.emplace_back(cloths.layer[p], count[p] > 0 ? sum[p] / count[p] : kMaxStartDepth, p);
    std::sort(order.begin(), order.end());
    std::vector<int> layers(order.size());
    for (size_t rank = 0; rank < order.size(); ++rank)
        layers[std::get<2>(order[rank])] = int(rank);
    return layers;
}

} // namespace toile::collision
