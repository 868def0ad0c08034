#include "garment/rivals/constraint_blocks.h"

#include <algorithm>

#include "core/mesh/colouring.h"
#include "garment/rivals/strain_constraints.h"

namespace toile {

namespace {

/// Vertices of a curvature stencil at most (curvature_stencil.h).
constexpr int kMaxStencil = 12;

/// Appends the blocks of one colour: append_block(lanes, count) with the items of eight lanes.
template <typename AppendBlock>
BlockRange append_colour(const std::vector<int>& items, int first, const AppendBlock& append_block)
{
    BlockRange range{first, 0};
    for (int k = 0; k < int(items.size()); k += kLanes, ++range.count) {
        const int count = std::min(kLanes, int(items.size()) - k);
        LaneIndices lanes;
        for (int lane = 0; lane < kLanes; ++lane)
            lanes[lane] = items[k + std::min(lane, count - 1)];
        append_block(lanes, count);
    }
    return range;
}

StrainBlock strain_block(const RestShape& rest, const LaneIndices& triangle, int count)
{
    StrainBlock block;
    block.count = count;
    for (int lane = 0; lane < kLanes; ++lane) {
        for (int k = 0; k < 3; ++k)
            block.corner[k][lane] = rest.triangles[triangle[lane]][k];
        for (int k = 0; k < 4; ++k)
            block.rest_inv(k)[lane] = rest.edges_inv[triangle[lane]](k);
        block.area[lane] = rest.areas[triangle[lane]];
    }
    return block;
}

void lay_out_strains(const RestShape& rest, ConstraintLayout& layout)
{
    for (const std::vector<int>& triangles : colour_triangles(rest.triangles, rest.vertex_count()))
        layout.strain_colours.push_back(
            append_colour(triangles, int(layout.strains.size()), [&](const LaneIndices& lanes, int count) {
                layout.strains.push_back(strain_block(rest, lanes, count));
            }));
}

CurvatureEntry curvature_entry(const std::vector<Bending::Term>& terms, const LaneIndices& term, int j)
{
    CurvatureEntry entry;
    for (int lane = 0; lane < kLanes; ++lane) {
        const CurvatureStencil& stencil = terms[term[lane]].stencil;
        const bool exists = j < int(stencil.vertex.size());
        entry.vertex[lane] = stencil.vertex[exists ? j : 0];
        for (int k = 0; k < 3; ++k)
            entry.weight[k][lane] = exists ? stencil.weights(k, j) : 0.0;
    }
    return entry;
}

void append_curvatures(const std::vector<Bending::Term>& terms, const LaneIndices& term, int count,
                       ConstraintLayout& layout)
{
    CurvatureBlock block;
    block.count = count;
    block.first_vertex = int(layout.entries.size());
    for (int lane = 0; lane < kLanes; ++lane) {
        block.vertices = std::max(block.vertices, int(terms[term[lane]].stencil.vertex.size()));
        for (int k = 0; k < 3; ++k)
            block.stiffness[k][lane] = terms[term[lane]].stiffness[k];
    }
    for (int j = 0; j < block.vertices; ++j)
        layout.entries.push_back(curvature_entry(terms, term, j));
    layout.curvatures.push_back(block);
}

void lay_out_curvatures(const ClothModel& cloth, ConstraintLayout& layout)
{
    if (cloth.bending.warp == 0.0 && cloth.bending.weft == 0.0)
        return;
    const std::vector<Bending::Term> terms = Bending::terms(*cloth.rest, cloth.bending, "Xpbd");
    Incidence vertices;
    vertices.first.push_back(0);
    for (const Bending::Term& term : terms) {
        vertices.items.insert(vertices.items.end(), term.stencil.vertex.begin(), term.stencil.vertex.end());
        vertices.first.push_back(int(vertices.items.size()));
    }
    for (std::vector<int>& stencils : colour_items(vertices, cloth.rest->vertex_count())) {
        // Stencils of equal size come into the same block.
        std::stable_sort(stencils.begin(), stencils.end(), [&](int a, int b) {
            return terms[a].stencil.vertex.size() < terms[b].stencil.vertex.size();
        });
        layout.curvature_colours.push_back(
            append_colour(stencils, int(layout.curvatures.size()), [&](const LaneIndices& lanes, int count) {
                append_curvatures(terms, lanes, count, layout);
            }));
    }
}

} // namespace

ConstraintLayout lay_out_constraints(const ClothModel& cloth)
{
    ConstraintLayout layout;
    lay_out_strains(*cloth.rest, layout);
    lay_out_curvatures(cloth, layout);
    return layout;
}

void ProjectStrains::operator()(int b) const
{
    // Deformation gradient, and N from the hat gradients of the three corners.
    const StrainBlock& block = blocks[b];
    const Mat2Of<Lanes>& inv = block.rest_inv;
    const Lanes hat_u[3] = {-inv(0, 0) - inv(1, 0), inv(0, 0), inv(1, 0)};
    const Lanes hat_v[3] = {-inv(0, 1) - inv(1, 1), inv(0, 1), inv(1, 1)};
    Vec3Of<Lanes> corner[3];
    Lanes mobility[3];
    Mat2Of<Lanes> N;
    N(0, 0) = N(0, 1) = N(1, 1) = Lanes(0.0);
    for (int k = 0; k < 3; ++k) {
        corner[k] = gather_vectors(x, block.corner[k]);
        mobility[k] = gather_numbers(inverse_masses, block.corner[k]);
        N(0, 0) += mobility[k] * hat_u[k] * hat_u[k];
        N(0, 1) += mobility[k] * hat_u[k] * hat_v[k];
        N(1, 1) += mobility[k] * hat_v[k] * hat_v[k];
    }
    N(1, 0) = N(0, 1);
    const Vec3Of<Lanes> e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    Mat32Of<Lanes> F;
    F.col(0) = inv(0, 0) * e1 + inv(1, 0) * e2;
    F.col(1) = inv(0, 1) * e1 + inv(1, 1) * e2;

    // Project, and move the corners.
    const Lanes scale = block.area * Lanes(h * h);
    const StrainStiffness<Lanes> stiffness{scale * Lanes(weights.warp), scale * Lanes(weights.weft),
                                           scale * Lanes(weights.shear)};
    const Mat32Of<Lanes> D = project_strains<Lanes>(F, N, stiffness);
    for (int k = 0; k < 3; ++k) {
        corner[k] += (mobility[k] * hat_u[k]) * D.col(0) + (mobility[k] * hat_v[k]) * D.col(1);
        scatter_vectors(corner[k], block.corner[k], block.count, x);
    }
}

void ProjectCurvatures::operator()(int b) const
{
    // Curvatures C_k = row_k x, relative to the first vertex (rows sum to zero), and G = rows M^-1 rows^T.
    const CurvatureBlock& block = blocks[b];
    const View<const CurvatureEntry> stencil = entries.subview(block.first_vertex, block.vertices);
    Vec3Of<Lanes> place[kMaxStencil];
    Lanes mobility[kMaxStencil];
    const Lanes zero(0.0);
    Vec3Of<Lanes> C[3];
    std::fill_n(C, 3, Vec3Of<Lanes>(zero, zero, zero));
    Lanes G[3][3];
    std::fill_n(&G[0][0], 9, zero);
    for (int j = 0; j < block.vertices; ++j) {
        place[j] = gather_vectors(x, stencil[j].vertex);
        mobility[j] = gather_numbers(inverse_masses, stencil[j].vertex);
        for (int k = 0; k < 3; ++k) {
            C[k] += stencil[j].weight[k] * (place[j] - place[0]);
            for (int l = k; l < 3; ++l)
                G[k][l] += mobility[j] * stencil[j].weight[k] * stencil[j].weight[l];
        }
    }

    // Gauss-Seidel over the three: d lambda_k = -C_k / (G_kk + 1 / (h^2 stiffness_k)).
    Vec3Of<Lanes> multiplier[3];
    for (int k = 0; k < 3; ++k) {
        const Lanes stiffness = Lanes(h * h) * block.stiffness[k];
        multiplier[k] = (-stiffness / (stiffness * G[k][k] + Lanes(1.0))) * C[k];
        for (int l = k + 1; l < 3; ++l)
            C[l] += G[k][l] * multiplier[k];
    }
    // Backwards: entries beyond the end of a stencil repeat its first vertex unmoved, which must not stay.
    for (int j = block.vertices - 1; j >= 0; --j) {
        for (int k = 0; k < 3; ++k)
            place[j] += (mobility[j] * stencil[j].weight[k]) * multiplier[k];
        scatter_vectors(place[j], stencil[j].vertex, block.count, x);
    }
}

} // namespace toile
