#include "garment/rivals/constraint_table.h"

#include "core/mesh/colouring.h"
#include "garment/rivals/bending_forces.h"
#include "garment/rivals/colours.h"
#include "garment/rivals/rival.h"

namespace toile {

namespace {

template <typename T>
void append_strains(const RestShape& rest, ConstraintTable<T>& table)
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
void append_curvatures(const ClothModel& cloth, ConstraintTable<T>& table)
{
    if (cloth.bending.warp == 0.0 && cloth.bending.weft == 0.0)
        return;
    const std::vector<Bending::Term> terms = Bending::terms(*cloth.rest, cloth.bending, "DeviceXpbd");
    for (const std::vector<int>& stencils : colour_stencils(terms, cloth.rest->vertex_count())) {
        table.curvature_colours.push_back({int(table.curvatures.size()), int(stencils.size())});
        for (const int s : stencils) {
            const CurvatureStencil& stencil = terms[s].stencil;
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

SparseMatrix bending_of(const ClothModel& cloth)
{
    return Bending(cloth.rest, cloth.bending, "DeviceXpbd").matrix();
}

} // namespace

template <typename T>
ConstraintTable<T>::ConstraintTable(const ClothModel& cloth)
    : weights(Membrane(cloth.rest, cloth.stretch, "DeviceXpbd").weights()),
      bending(sliced_rows_of(bending_of(cloth))),
      fastest_bending(toile::fastest_bending(bending_of(cloth), cloth.masses)), masses(cloth.masses)
{
    append_strains(*cloth.rest, *this);
    append_curvatures(cloth, *this);
}

template struct ConstraintTable<float>;
template struct ConstraintTable<double>;

} // namespace toile
