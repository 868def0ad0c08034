#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "research/paper_rule/gaussian_fit.h"

namespace toile::research {

/// Cell of a grid in Dim dimensions: a pixel (column, row) in the plane.
template <int Dim>
using Voxel = std::array<int, Dim>;

/// Box of voxels, `first` and `last` included.
template <int Dim>
struct VoxelBox {
    Voxel<Dim> first{}, last{};

    int extent(int axis) const { return last[axis] - first[axis] + 1; }
    bool contains(const Voxel<Dim>& voxel) const
    {
        for (int axis = 0; axis < Dim; ++axis)
            if (voxel[axis] < first[axis] || voxel[axis] > last[axis])
                return false;
        return true;
    }

    /// Calls visit(voxel) for every voxel of the box, the first axis fastest.
    template <typename Visit>
    void for_each(const Visit& visit) const
    {
        Voxel<Dim> voxel = first;
        for (int axis = 0; axis < Dim;) {
            visit(voxel);
            for (axis = 0; axis < Dim && ++voxel[axis] > last[axis]; ++axis)
                voxel[axis] = first[axis];
        }
    }
};

/// Bounding box cut into equal voxels [multilevel quadrature for PD, Alg. 1, line 1].
template <int Dim>
struct VoxelGrid {
    Box<Dim> bounds;                                 ///< [m]
    Voxel<Dim> size{};                               ///< voxels along each axis
    Point<Dim> voxel_size = Point<Dim>::Constant(1); ///< [m]

    VoxelGrid() = default;

    /// @param voxels  along the longest side; the others have as many as make them nearly cubes
    VoxelGrid(const Box<Dim>& box, int voxels) : bounds(box)
    {
        const double edge = box.sizes().maxCoeff() / voxels;
        for (int axis = 0; axis < Dim; ++axis) {
            size[axis] = std::max(1, int(std::lround(box.sizes()[axis] / edge)));
            voxel_size[axis] = box.sizes()[axis] / size[axis];
        }
    }

    int count() const
    {
        int product = 1;
        for (const int along : size)
            product *= along;
        return product;
    }
    bool contains(const Voxel<Dim>& voxel) const
    {
        for (int axis = 0; axis < Dim; ++axis)
            if (voxel[axis] < 0 || voxel[axis] >= size[axis])
                return false;
        return true;
    }
    int index(const Voxel<Dim>& voxel) const
    {
        int index = 0;
        for (int axis = Dim - 1; axis >= 0; --axis)
            index = index * size[axis] + voxel[axis];
        return index;
    }
    Voxel<Dim> at(int index) const
    {
        Voxel<Dim> voxel;
        for (int axis = 0; axis < Dim; index /= size[axis++])
            voxel[axis] = index % size[axis];
        return voxel;
    }

    /// Voxel that holds the point, or the nearest one.
    Voxel<Dim> voxel_of(const Point<Dim>& point) const
    {
        Voxel<Dim> voxel;
        for (int axis = 0; axis < Dim; ++axis)
            voxel[axis] = std::clamp(int(std::floor((point[axis] - bounds.min()[axis]) / voxel_size[axis])),
                                     0, size[axis] - 1);
        return voxel;
    }

    Box<Dim> box_of(const VoxelBox<Dim>& voxels) const
    {
        Point<Dim> first, end;
        for (int axis = 0; axis < Dim; ++axis) {
            first[axis] = voxels.first[axis];
            end[axis] = voxels.last[axis] + 1;
        }
        return {bounds.min() + first.cwiseProduct(voxel_size), bounds.min() + end.cwiseProduct(voxel_size)};
    }
};

} // namespace toile::research
