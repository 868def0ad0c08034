#include "research/methods/vbd/vertex_sweep.h"

#include <algorithm>

#include "research/methods/colours.h"

namespace toile::research {

namespace {

/// Appends blocks to a layout.
class Layouter {
public:
    Layouter(const garment::ClothModel& cloth, const SparseMatrix& K, SweepLayout& layout)
        : cloth_(cloth), corners_(cloth.rest->topology.corners_of_vertex), K_(K), rows_(couplings(K)),
          layout_(layout)
    {
    }

    /// Appends blocks of one colour. A block has vertices with nearly equal numbers of terms.
    void append_colour(std::vector<int> vertices)
    {
        std::stable_sort(vertices.begin(), vertices.end(), [&](int a, int b) {
            const int ring_a = corners_.of(a).size(), ring_b = corners_.of(b).size();
            return ring_a != ring_b ? ring_a < ring_b : rows_[a].size() < rows_[b].size();
        });
        const int first = int(layout_.blocks.size());
        for (int k = 0; k < int(vertices.size()); k += kLanes)
            append_block(View<const int>(vertices).subview(k, std::min(kLanes, int(vertices.size()) - k)));
        layout_.colours.push_back({first, int(layout_.blocks.size()) - first});
    }

private:
    void append_block(View<const int> vertices)
    {
        VertexBlock block;
        block.count = vertices.size();
        for (int lane = 0; lane < kLanes; ++lane) {
            const int v = vertices[std::min(lane, block.count - 1)];
            block.vertex[lane] = v;
            block.mass[lane] = cloth_.masses[v];
            block.bending[lane] = K_.coeff(v, v);
            block.triangles = std::max(block.triangles, corners_.of(v).size());
            block.bends = std::max(block.bends, int(rows_[v].size()));
        }
        block.first_triangle = int(layout_.triangles.size());
        for (int k = 0; k < block.triangles; ++k)
            layout_.triangles.push_back(ring_triangle(block.vertex, k));
        block.first_bend = int(layout_.bend_vertex.size());
        for (int k = 0; k < block.bends; ++k)
            append_bend(block.vertex, k);
        layout_.blocks.push_back(block);
    }

    RingTriangle ring_triangle(const LaneIndices& vertex, int k) const
    {
        RingTriangle result;
        for (int lane = 0; lane < kLanes; ++lane) {
            const int v = vertex[lane];
            const bool exists = k < corners_.of(v).size();
            const int corner = exists ? corners_.of(v)[k] : 0;
            const Triangle& triangle = cloth_.rest->triangles[corner / 3];
            result.corner1[lane] = exists ? triangle[(corner + 1) % 3] : v;
            result.corner2[lane] = exists ? triangle[(corner + 2) % 3] : v;

            // Compute the hat gradients of corners 0, 1, 2 in the stored order of the triangle.
            Mat32 hats;
            hats.bottomRows<2>() = cloth_.rest->edges_inv[corner / 3];
            hats.row(0) = -hats.row(1) - hats.row(2);
            for (int axis = 0; axis < 2; ++axis) {
                result.rest_inv(0, axis)[lane] = exists ? hats((corner + 1) % 3, axis) : 0.0;
                result.rest_inv(1, axis)[lane] = exists ? hats((corner + 2) % 3, axis) : 0.0;
            }
            result.area[lane] = exists ? cloth_.rest->areas[corner / 3] : 0.0;
        }
        return result;
    }

    void append_bend(const LaneIndices& vertex, int k)
    {
        LaneIndices neighbour;
        Lanes stiffness;
        for (int lane = 0; lane < kLanes; ++lane) {
            const auto& row = rows_[vertex[lane]];
            const bool exists = k < int(row.size());
            neighbour[lane] = exists ? row[k].vertex : vertex[lane];
            stiffness[lane] = exists ? row[k].stiffness : 0.0;
        }
        layout_.bend_vertex.push_back(neighbour);
        layout_.bend_stiffness.push_back(stiffness);
    }

    const garment::ClothModel& cloth_;
    const Incidence& corners_;
    const SparseMatrix& K_;
    std::vector<std::vector<Coupling>> rows_;
    SweepLayout& layout_;
};

} // namespace

SweepLayout lay_out_sweep(const garment::ClothModel& cloth, const SparseMatrix& K)
{
    SweepLayout layout;
    Layouter layouter(cloth, K, layout);
    for (std::vector<int>& vertices : colour_vertices(*cloth.rest, K))
        layouter.append_colour(std::move(vertices));
    return layout;
}

// Inlines the operators of Lanes, as parallel_for_lanes() does.
[[gnu::flatten]] void DescendVertices::operator()(int b) const
{
    // Add inertia and the row of K: W_bending = 1/2 x^T K x, whose rows sum to zero.
    const VertexBlock& block = layout.blocks[b];
    const Vec3Of<Lanes> self = gather_vectors(x, block.vertex);
    const Lanes inertia = block.mass * Lanes(1.0 / (dt * dt));
    Vec3Of<Lanes> gradient = inertia * (self - gather_vectors(prediction, block.vertex));
    Symmetric3<Lanes> hessian(inertia + block.bending);
    for (int k = block.first_bend; k < block.first_bend + block.bends; ++k)
        gradient += layout.bend_stiffness[k] * (gather_vectors(x, layout.bend_vertex[k]) - self);

    // Add the membrane: the vertex is corner 0 of each triangle.
    for (int k = block.first_triangle; k < block.first_triangle + block.triangles; ++k) {
        const RingTriangle& triangle = layout.triangles[k];
        const Vec3Of<Lanes> e1 = gather_vectors(x, triangle.corner1) - self;
        const Vec3Of<Lanes> e2 = gather_vectors(x, triangle.corner2) - self;
        add_first_corner<Lanes>(e1, e2, triangle.rest_inv, triangle.area, weights, gradient, hessian);
    }

    const Vec3Of<Lanes> step = hessian.solve(gradient);
    moved[b] = 0.0;
    for (int lane = 0; lane < block.count; ++lane) {
        const int v = block.vertex[lane];
        if (fixed[v])
            continue;
        const Vec3 move(step(0)[lane], step(1)[lane], step(2)[lane]);
        x[v] -= move;
        moved[b] = std::max(moved[b], move.squaredNorm());
    }
}

} // namespace toile::research
