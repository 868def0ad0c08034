#include "research/methods/xpbd/constraint_table.h"

#include "core/mesh/colouring.h"
#include "garment/energy/membrane.h"
#include "research/methods/baseline_method.h"
#include "research/methods/bending_forces.h"
#include "research/methods/colours.h"

namespace toile::research {

namespace {

template <typename T>
void append_strains(const garment::RestShape& rest, ConstraintTable<T>& table)
{
    for (const std::vector<int>& triangles : colour_triangles(rest.triangles, rest.vertex_count())) {
        table.strain_colours.push_back({int(table.strains.size()), int(triangles.size())});
        for (const int t : triangles) {
            StrainItem<T> item;
            for (int k = 0; k < 3; ++k)
                item.corner[k] = rest.triangles[t][k];
            for (int k = 0; k < 4; ++k)
                item.rest_inv[k] = T(rest.edges_inv[t](k / 2, k % 2));
            item.area = T(rest.areas[t]);
            table.strains.push_back(item);
        }
    }
}

template <typename T>
void append_curvatures(const garment::ClothModel& cloth, ConstraintTable<T>& table)
{
    if (cloth.bending.warp == 0.0 && cloth.bending.weft == 0.0)
        return;
    const std::vector<garment::Bending::Term> terms =
        garment::Bending::terms(*cloth.rest, cloth.bending, "DeviceXpbd");
    for (const std::vector<int>& stencils : colour_stencils(terms, cloth.rest->vertex_count())) {
        table.curvature_colours.push_back({int(table.curvatures.size()), int(stencils.size())});
        for (const int s : stencils) {
            const garment::CurvatureStencil& stencil = terms[s].stencil;
            CurvatureItem<T> item{int(table.entries.size()), int(stencil.vertex.size()), {}};
            for (int k = 0; k < 3; ++k)
                item.stiffness[k] = T(terms[s].stiffness[k]);
            table.curvatures.push_back(item);
            for (int j = 0; j < item.count; ++j) {
                CurvatureItemEntry<T> entry{stencil.vertex[j], {}};
                for (int k = 0; k < 3; ++k)
                    entry.weight[k] = T(stencil.weights(k, j));
                table.entries.push_back(entry);
            }
        }
    }
}

SparseMatrix bending_of(const garment::ClothModel& cloth)
{
    return garment::Bending(cloth.rest, cloth.bending, "DeviceXpbd").matrix();
}

} // namespace

template <typename T>
ConstraintTable<T>::ConstraintTable(const garment::ClothModel& cloth)
    : weights(garment::Membrane(cloth.rest, cloth.stretch, "DeviceXpbd").weights()),
      bending(sliced_rows_of(bending_of(cloth))),
      fastest_bending(toile::research::fastest_bending(bending_of(cloth), cloth.masses)), masses(cloth.masses)
{
    append_strains(*cloth.rest, *this);
    append_curvatures(cloth, *this);
}

template struct ConstraintTable<float>;
template struct ConstraintTable<double>;

} // namespace toile::research
