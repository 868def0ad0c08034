#pragma once

#include "export/point_cache.h"

namespace toile::exports {

/// A cache of irregular times at all whole frames of a rate, from the last one before its first sample to the
/// first one after its last: linear between samples, held outside of them.
/// @param cache  with times()
/// @param fps    [frames/s] positive
/// @param file   of the cache, for errors
/// @throws InvalidInput for times that do not increase, and for more frames than a cache can have
PointCache resampled(const PointCache& cache, double fps, const std::filesystem::path& file);

} // namespace toile::exports
