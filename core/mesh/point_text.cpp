#include "core/mesh/point_text.h"

#include "core/base/number.h"

namespace toile {

std::string point_text(const Vec3& point)
{
    return "(" + short_text(point.x()) + ", " + short_text(point.y()) + ", " + short_text(point.z()) + ")";
}

} // namespace toile
