#include "research/methods/xpbd/constraint_blocks.h"

#include <algorithm>

#include "core/mesh/colouring.h"
#include "research/methods/colours.h"
#include "research/methods/xpbd/curvature_constraints.h"
#include "research/methods/xpbd/strain_constraints.h"

namespace toile::research {

namespace {

/// Maximum number of vertices of a curvature stencil (curvature_stencil.h).
constexpr int kMaxStencil = 12;

/// Appends the blocks of one colour: calls append_block(lanes, count) with the items of eight lanes.
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

StrainBlock strain_block(const garment::RestShape& rest, const LaneIndices& triangle, int count)
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

void lay_out_strains(const garment::RestShape& rest, ConstraintLayout& layout)
{
    for (const std::vector<int>& triangles : colour_triangles(rest.triangles, rest.vertex_count()))
        layout.strain_colours.push_back(
            append_colour(triangles, int(layout.strains.size()), [&](const LaneIndices& lanes, int count) {
                layout.strains.push_back(strain_block(rest, lanes, count));
            }));
}

CurvatureEntry curvature_entry(const std::vector<garment::Bending::Term>& terms, const LaneIndices& term,
                               int j)
{
    CurvatureEntry entry;
    for (int lane = 0; lane < kLanes; ++lane) {
        const garment::CurvatureStencil& stencil = terms[term[lane]].stencil;
        const bool exists = j < int(stencil.vertex.size());
        entry.vertex[lane] = stencil.vertex[exists ? j : 0];
        for (int k = 0; k < 3; ++k)
            entry.weight[k][lane] = exists ? stencil.weights(k, j) : 0.0;
    }
    return entry;
}

void append_curvatures(const std::vector<garment::Bending::Term>& terms, const LaneIndices& term, int count,
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

void lay_out_curvatures(const garment::ClothModel& cloth, ConstraintLayout& layout)
{
    if (cloth.bending.warp == 0.0 && cloth.bending.weft == 0.0)
        return;
    const std::vector<garment::Bending::Term> terms =
        garment::Bending::terms(*cloth.rest, cloth.bending, "Xpbd");
    for (std::vector<int>& stencils : colour_stencils(terms, cloth.rest->vertex_count())) {
        // Sort so that stencils of equal size share a block.
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

ConstraintLayout lay_out_constraints(const garment::ClothModel& cloth)
{
    ConstraintLayout layout;
    lay_out_strains(*cloth.rest, layout);
    lay_out_curvatures(cloth, layout);
    return layout;
}

void ProjectStrains::operator()(int b) const
{
    const StrainBlock& block = blocks[b];
    Vec3Of<Lanes> corner[3];
    StrainTriangle<Lanes> triangle;
    for (int k = 0; k < 3; ++k) {
        corner[k] = gather_vectors(x, block.corner[k]);
        triangle.mobility[k] = gather_numbers(inverse_masses, block.corner[k]);
    }
    triangle.edge1 = corner[1] - corner[0];
    triangle.edge2 = corner[2] - corner[0];
    triangle.rest_inv = block.rest_inv;
    triangle.area = block.area;

    const Mat3Of<Lanes> moves = strain_moves<Lanes>(triangle, weights, h);
    for (int k = 0; k < 3; ++k) {
        corner[k] += moves.col(k);
        scatter_vectors(corner[k], block.corner[k], block.count, x);
    }
}

void ProjectCurvatures::operator()(int b) const
{
    const CurvatureBlock& block = blocks[b];
    const View<const CurvatureEntry> stencil = entries.subview(block.first_vertex, block.vertices);
    Vec3Of<Lanes> position[kMaxStencil];
    Lanes mobility[kMaxStencil];
    CurvatureConstraints<Lanes> constraints;
    for (int j = 0; j < block.vertices; ++j) {
        position[j] = gather_vectors(x, stencil[j].vertex);
        mobility[j] = gather_numbers(inverse_masses, stencil[j].vertex);
        constraints.add(stencil[j].weight, mobility[j], position[j] - position[0]);
    }
    constraints.project(block.stiffness, h);

    // Write in reverse: entries beyond the end of a stencil write its first vertex unmoved, which the first
    // entry must overwrite.
    for (int j = block.vertices - 1; j >= 0; --j) {
        for (int k = 0; k < 3; ++k)
            position[j] += (mobility[j] * stencil[j].weight[k]) * constraints.multiplier(k);
        scatter_vectors(position[j], stencil[j].vertex, block.count, x);
    }
}

} // namespace toile::research
