#include "research/methods/vbd/sweep_table.h"

#include <cmath>

#include "garment/energy/membrane.h"
#include "research/methods/baseline_method.h"
#include "research/methods/colours.h"

namespace toile::research {

namespace {

/// A triangle rotated so that `corner` (3 * triangle + corner) is its first.
template <typename T>
SweepTriangle<T> rotated(const garment::RestShape& rest, int corner)
{
    const Triangle& triangle = rest.triangles[corner / 3];
    Mat32 hats; // gradients of corners 0, 1, 2 in the stored order of the triangle
    hats.bottomRows<2>() = rest.edges_inv[corner / 3];
    hats.row(0) = -hats.row(1) - hats.row(2);
    const int next = (corner + 1) % 3, last = (corner + 2) % 3;
    return {triangle[next],
            triangle[last],
            {T(hats(next, 0)), T(hats(next, 1)), T(hats(last, 0)), T(hats(last, 1))},
            T(rest.areas[corner / 3])};
}

SparseMatrix bending_of(const garment::ClothModel& cloth)
{
    return garment::Bending(cloth.rest, cloth.bending, "DeviceVertexBlockDescent").matrix();
}

} // namespace

template <typename T>
SweepTable<T>::SweepTable(const garment::ClothModel& cloth, bool lags_bending)
    : weights(garment::Membrane(cloth.rest, cloth.stretch, "DeviceVertexBlockDescent").weights()),
      bending(sliced_rows_of(bending_of(cloth))), masses(cloth.masses)
{
    const garment::RestShape& rest = *cloth.rest;
    const SparseMatrix K = bending_of(cloth);
    const std::vector<std::vector<Coupling>> rows = couplings(K);
    for (const std::vector<int>& vertices : colour_vertices(rest, lags_bending ? SparseMatrix() : K)) {
        colours.push_back({int(items.size()), int(vertices.size())});
        for (const int v : vertices) {
            SweepItem<T> item;
            item.vertex = v;
            item.mass = T(cloth.masses[v]);
            item.bending = T(K.coeff(v, v));
            item.first_triangle = int(triangles.size());
            for (const int corner : rest.topology.corners_of_vertex.of(v))
                triangles.push_back(rotated<T>(rest, corner));
            item.triangle_end = int(triangles.size());
            item.first_bend = int(bends.size());
            for (const Coupling& entry : rows[v])
                if (lags_bending)
                    item.bending += T(std::abs(entry.stiffness));
                else
                    bends.push_back({entry.vertex, T(entry.stiffness)});
            item.bend_end = int(bends.size());
            items.push_back(item);
        }
    }
}

template struct SweepTable<float>;
template struct SweepTable<double>;

} // namespace toile::research
