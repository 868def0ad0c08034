#pragma once

#include <array>
#include <cfenv>

#include "core/compute/types.h"

namespace toile::collision {

/// Two triangles in space. Shared corners come first, in the same order in both.
struct TrianglePair {
    std::array<Vec3, 3> a, b; ///< [m] finite
    int shared = 0;           ///< corners in common, 0 to 3
    bool is_flat = false;     ///< one of them has no area (see has_no_area)
};

/// IEEE arithmetic with denormal numbers, rounding to nearest, for this thread and scope. Embree leaves its
/// calling threads flushing denormals to zero; the predicates below then err on numbers near 1e-308. Costs as
/// much as a predicate: use one for many.
class StandardArithmetic {
public:
    StandardArithmetic()
    {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~StandardArithmetic() { std::fesetenv(&before_); }
    StandardArithmetic(const StandardArithmetic&) = delete;
    StandardArithmetic& operator=(const StandardArithmetic&) = delete;

private:
    std::fenv_t before_;
};

/// True if the triangles have a point in common beyond the corners, or the edge, that they share. Exact under
/// StandardArithmetic: rounding has no influence. Triangles are closed sets, and one without area is the
/// segment or point it covers.
///
///   shared  crosses if
///   0       they have any point in common; touching counts
///   1       the edge opposite to the shared corner meets the other triangle: a path from the corner inside
///           both triangles leaves one of them through that edge
///   2       they are folded exactly flat onto each other
///   3       never: they are the same triangle
bool crosses(const TrianglePair& pair);

/// True if the corners lie on one line. Exact under any arithmetic.
bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace toile::collision
