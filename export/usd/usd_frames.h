#pragma once

#include <memory>
#include <string>

#include "export/binary_file.h"
#include "export/point_cache.h"

namespace toile::exports {

/// Frames of a mesh as usd_commands.py leaves them, little endian:
///
///   char[8]   ToileUSD
///   uint32    points, frames, samples a frame
///   double    frames a second, start frame, metres of a unit
///   uint32    1: Z is up; 1: faces are clockwise; scope of texture coordinates: 0 none, 1 corners, 2 points
///   uint32 n, double[n]       times of the frames [s], where they are irregular; else n = 0
///   uint32 n, int32[n]        corners of each face
///   uint32 n, int32[n]        points of the corners
///   uint32 n, float[n][2]     texture coordinates
///   uint32 n, int32[n]        their indices
///   uint32 groups, and each: uint32 n, char[n] name; uint32 n, int32[n] faces
///   frames, each: double[4][4] transform of rows (x y z 1); float[points][3]
///
/// Units other than metres and centimetres are converted into metres.
/// @param name  of what was read, for errors
/// @throws InvalidInput for sizes that are not those of the file, points of faces out of range, and frames
///         without a rate or times
std::unique_ptr<const PointCache::Source> open_usd_frames(std::unique_ptr<const BinaryFile> file,
                                                          const std::string& name);

} // namespace toile::exports
