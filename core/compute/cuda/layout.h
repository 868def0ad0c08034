#pragma once

#include <cstddef>

#include "core/compute/types.h"

namespace toile {

/// Memory layout of Eigen's types, which follows from the instruction set that a source is compiled for.
/// Sources that disagree would exchange garbage. As a template argument the disagreement becomes an error of
/// the linker: "undefined reference to EigenLayout<...>::agreed()". layout.cpp defines it for what .cpp files
/// see; parallel.cuh requires it as .cu files see it.
template <std::size_t... alignments_and_sizes>
struct EigenLayout {
    static void agreed();
};

using OurEigenLayout =
    EigenLayout<EIGEN_MAX_STATIC_ALIGN_BYTES, alignof(Vec2), sizeof(Vec2), alignof(Vec3), sizeof(Vec3),
                alignof(Mat2), sizeof(Mat2), alignof(Mat3), sizeof(Mat3), alignof(Mat32), sizeof(Mat32),
                alignof(Eigen::Matrix<double, 3, 4>), sizeof(Eigen::Matrix<double, 3, 4>),
                alignof(Eigen::Matrix4d), sizeof(Eigen::Matrix4d), alignof(Triangle), sizeof(Triangle)>;

} // namespace toile
