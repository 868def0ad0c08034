#pragma once

#include <array>
#include <cfenv>

#include "core/backend/types.h"

namespace toile {

/// Two triangles in space. Corners that they share come first, in the same order in both.
struct TrianglePair {
    std::array<Vec3, 3> a, b; ///< [m] finite
    int shared = 0;           ///< corners in common, 0 to 3
    bool is_flat = false;     ///< one of them has no area (see has_no_area)
};

/// IEEE arithmetic with denormal numbers, rounding to nearest, for this thread and scope. Embree leaves
/// threads that called it flushing denormals to zero, and then the predicates below err on numbers near
/// 1e-308. Costs as much as a predicate: one for many.
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

/// True when the triangles have a point in common beyond the corners, or the edge, that they share. Exact,
/// under StandardArithmetic: no rounding decides. Triangles are closed sets, and one without area is the
/// segment or point it covers.
///
///   shared  crosses when
///   0       they have any point in common; touching counts
///   1       the edge opposite to the shared corner meets the other triangle: whoever leaves the corner
///   inside
///           both triangles leaves one of them through that edge
///   2       they are folded exactly flat onto each other
///   3       never: they are the same triangle
bool crosses(const TrianglePair& pair);

/// True when the corners lie on one line. Exact, under any arithmetic.
bool has_no_area(const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace toile
