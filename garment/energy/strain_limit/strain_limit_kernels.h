#pragma once

#include "core/compute/team.h"
#include "garment/energy/principal_stretch.h"

namespace toile::garment {

/// Mass of a fixed vertex relative to the heaviest free one while a triangle is fitted [-].
constexpr double kFixedMassRatio = 1e6;

/// Stretch limits for one kind of triangle; see StrainLimit.
struct StretchLimits {
    double allowed = 1.06;    ///< [-] maximum principal stretch
    double tolerated = 1.061; ///< [-] stretch up to which a triangle is not clamped; slivers: infinite
};

/// Triangles whose principal stretches are limited.
struct LimitedTriangles {
    View<const Triangle> tri;  ///< [triangles] vertex indices
    View<const Mat2> rest;     ///< [triangles] rest edge matrices [m]
    View<const Mat2> rest_inv; ///< [triangles] their inverses [1/m]
    View<const int> kind;      ///< [triangles] into limits
    View<const StretchLimits> limits;

    TOILE_HD Mat32 deformation_gradient(int t, View<const Vec3> x) const
    {
        Mat32 edges;
        edges.col(0) = x[tri[t][1]] - x[tri[t][0]];
        edges.col(1) = x[tri[t][2]] - x[tri[t][0]];
        return edges.lazyProduct(rest_inv[t]);
    }
    TOILE_HD double stretch(int t, View<const Vec3> x) const
    {
        return largest_stretch(deformation_gradient(t, x));
    }
    TOILE_HD bool violates(int t, View<const Vec3> x) const
    {
        return stretch(t, x) > limits[kind[t]].tolerated;
    }
};

/// Masses of a triangle's corners up to a common factor.
TOILE_HD inline Vec3 relative_masses(const Triangle& corner, View<const double> inverse_masses)
{
    Vec3 masses;
    double heaviest = 0.0;
    for (int k = 0; k < 3; ++k) {
        masses[k] = inverse_masses[corner[k]] > 0.0 ? 1.0 / inverse_masses[corner[k]] : 0.0;
        heaviest = std::fmax(heaviest, masses[k]);
    }
    for (int k = 0; k < 3; ++k)
        if (masses[k] == 0.0)
            masses[k] = kFixedMassRatio * heaviest;
    return masses;
}

/// Moves a triangle, mass-weighted, to the closest edges with clamped singular values.
struct ClampTriangle {
    LimitedTriangles triangles;
    View<const double> inverse_masses; ///< [vertices] [1/kg], 0 for fixed vertices
    View<Vec3> x;                      ///< [vertices] [m]; the triangle's vertices are written

    TOILE_HD void operator()(int t) const
    {
        const Triangle& corner = triangles.tri[t];
        const Mat32 F = triangles.deformation_gradient(t, x);
        const PrincipalStretch stretch = principal_stretch(F);
        const double allowed = triangles.limits[triangles.kind[t]].allowed;
        if (stretch.sigma[0] <= allowed)
            return;

        // Clamped edges: F V diag(min(sigma, allowed) / sigma) V^T times the rest edges.
        const Mat2 scale = stretch.with(allowed / stretch.sigma[0],
                                        std::fmin(1.0, allowed / std::fmax(stretch.sigma[1], 1e-300)));
        const Mat32 clamped = F.lazyProduct(scale);
        const Mat32 edges = clamped.lazyProduct(triangles.rest[t]);

        // Keep the centre of mass; fixed corners are heavy in the fit and do not move at all.
        const Vec3 masses = relative_masses(corner, inverse_masses);
        const double mass = masses.sum();
        const Vec3 center =
            (masses[0] * x[corner[0]] + masses[1] * x[corner[1]] + masses[2] * x[corner[2]]) / mass;
        const Vec3 first = center - (masses[1] * edges.col(0) + masses[2] * edges.col(1)) / mass;
        for (int k = 0; k < 3; ++k)
            if (inverse_masses[corner[k]] > 0.0) {
                x[corner[k]] = first;
                if (k > 0)
                    x[corner[k]] += edges.col(k - 1);
            }
    }
};

// The following kernels run on a GPU only.

/// Clamps the k-th triangle of one colour if it violates its limit.
struct ClampOfColour {
    ClampTriangle clamp;
    View<const int> of_colour;          ///< triangles
    View<const unsigned char> violates; ///< [triangles] at the start of the sweep
    View<const int> violating;          ///< [1] number of violating triangles

    TOILE_HD void operator()(int k) const
    {
        if (violating[0] > 0 && violates[of_colour[k]])
            clamp(of_colour[k]);
    }
};

/// Marks triangle t and returns 1 if it violates its limit, so that a sum counts such triangles.
struct CountViolating {
    LimitedTriangles triangles;
    View<const Vec3> x;           ///< [vertices] [m]
    View<unsigned char> violates; ///< [triangles] out

    TOILE_HD int operator()(int t) const
    {
        const int count = triangles.violates(t, x) ? 1 : 0;
        violates[t] = count > 0;
        return count;
    }
};

/// CountViolating after a sweep. If nothing violated its limit before the sweep, nothing has moved.
struct CountViolatingAfter {
    CountViolating count;
    View<const int> violating; ///< [1] before the sweep

    TOILE_HD int operator()(int t) const { return violating[0] > 0 ? count(t) : 0; }
};

/// Maximum principal stretch of triangle t.
struct StretchOfTriangle {
    LimitedTriangles triangles;
    View<const Vec3> x; ///< [vertices] [m]

    TOILE_HD double operator()(int t) const { return triangles.stretch(t, x); }
};

/// Maximum term of range r, by a block of threads: a power of two, with a double of shared memory each.
template <typename Term>
struct LargestOfRange {
    Term term;             ///< not negative
    View<const int> first; ///< [ranges + 1]
    View<double> largest;  ///< [ranges] out; 0 for an empty range

    template <int Threads>
    TOILE_HD void operator()(int r, const Block<Threads>& block) const
    {
        auto* const of_thread = static_cast<double*>(block.memory);
        double thread_max = 0.0;
        for (int i = first[r] + block.thread; i < first[r + 1]; i += Threads)
            thread_max = std::fmax(thread_max, term(i));
        of_thread[block.thread] = thread_max;
        for (int width = Threads / 2; width > 0; width /= 2) {
            block.wait();
            if (block.thread < width)
                of_thread[block.thread] = std::fmax(of_thread[block.thread], of_thread[block.thread + width]);
        }
        if (block.thread == 0)
            largest[r] = of_thread[0];
    }
};

/// Saves the position of vertex v.
struct KeepPosition {
    View<const Vec3> x; ///< [vertices] [m]
    View<Vec3> kept;    ///< [vertices] out

    TOILE_HD void operator()(int v) const { kept[v] = x[v]; }
};

/// Restores vertex v if its cloth exceeded its limit at first and ended with a larger stretch than it began
/// with. Cloth within its limit keeps the corrections of contact clearing.
struct UndoVertex {
    View<const int> cloth;                     ///< [vertices] -1: no cloth
    View<const double> tolerated;              ///< [cloths] maximum stretch
    View<const double> stretch_t0, stretch_t1; ///< [cloths] maximum, before and after
    View<const Vec3> kept;                     ///< [vertices] [m]
    View<Vec3> x;                              ///< [vertices] in, out [m]

    TOILE_HD void operator()(int v) const
    {
        const int c = cloth[v];
        if (c >= 0 && stretch_t0[c] > tolerated[c] && stretch_t1[c] > stretch_t0[c])
            x[v] = kept[v];
    }
};

} // namespace toile::garment
