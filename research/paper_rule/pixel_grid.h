#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "research/paper_rule/gaussian_fit.h"

namespace toile::research {

using Pixel = std::array<int, 2>; ///< column, row

/// Rectangle of pixels, `first` and `last` included.
struct PixelBox {
    Pixel first{}, last{};

    int extent(int axis) const { return last[axis] - first[axis] + 1; }
    bool contains(const Pixel& pixel) const
    {
        return pixel[0] >= first[0] && pixel[0] <= last[0] && pixel[1] >= first[1] && pixel[1] <= last[1];
    }
};

/// Bounding box cut into equal pixels: the two-dimensional voxels of Alg. 1, line 1.
struct PixelGrid {
    Box<2> bounds;         ///< [m]
    Pixel size{};          ///< columns, rows
    Vec2 pixel_size{1, 1}; ///< [m]

    PixelGrid() = default;

    /// @param pixels  along the longer side; the other side has as many as make them nearly square
    PixelGrid(const Box<2>& box, int pixels) : bounds(box)
    {
        const double edge = box.sizes().maxCoeff() / pixels;
        for (int axis = 0; axis < 2; ++axis) {
            size[axis] = std::max(1, int(std::lround(box.sizes()[axis] / edge)));
            pixel_size[axis] = box.sizes()[axis] / size[axis];
        }
    }

    int count() const { return size[0] * size[1]; }
    int index(const Pixel& pixel) const { return pixel[1] * size[0] + pixel[0]; }
    Pixel at(int index) const { return {index % size[0], index / size[0]}; }

    /// Pixel that holds the point, or the nearest one.
    Pixel pixel_of(const Vec2& point) const
    {
        Pixel pixel;
        for (int axis = 0; axis < 2; ++axis)
            pixel[axis] = std::clamp(int(std::floor((point[axis] - bounds.min()[axis]) / pixel_size[axis])),
                                     0, size[axis] - 1);
        return pixel;
    }

    Box<2> box_of(const PixelBox& pixels) const
    {
        const Vec2 first(pixels.first[0], pixels.first[1]), end(pixels.last[0] + 1, pixels.last[1] + 1);
        return {bounds.min() + first.cwiseProduct(pixel_size), bounds.min() + end.cwiseProduct(pixel_size)};
    }
};

} // namespace toile::research
