#pragma once

#include <string>

#include "core/compute/types.h"

namespace toile {

/// "(0.1, -2, 0.35)", with three digits of each coordinate: a place, in messages.
std::string point_text(const Vec3& point);

} // namespace toile
