#pragma once

#include "core/linear/sliced_rows.h"
#include "research/methods/particle.h"
#include "research/methods/xpbd/constraint_table.h"
#include "research/methods/xpbd/curvature_constraints.h"
#include "research/methods/xpbd/strain_constraints.h"

namespace toile::research {

/// Kernels of Xpbd on a GPU. Two arrays of particles alternate: `before` is the start of a substep, `after`
/// its end, not final until all constraints have run.

/// Initialises both arrays at the start of a step, with the mobilities.
struct BeginParticle {
    View<const Vec3> x;          ///< [vertices] [m]
    View<const double> mobility; ///< [vertices] [1/kg]
    View<Particle> before, after;

    TOILE_HD void operator()(int i) const
    {
        before[i] = Particle(x[i], mobility[i]);
        after[i] = before[i];
    }
};

/// Predicts a substep. Free vertices move with their velocity, gravity and, if enabled, bending forces. Fixed
/// vertices move on a straight line to their target. A team of threads shares the row of K.
struct PredictParticle {
    View<const int> first_entry;   ///< [slices + 1] of SlicedRows; empty: no bending
    View<const RowEntry> entries;  ///< of K [N/m]
    View<const Vec3> velocity;     ///< [vertices] at the start of the step [m/s]
    View<const Vec3> acceleration; ///< [vertices] [m/s^2]
    View<const Vec3> start;        ///< [vertices] at the start of the step [m]
    View<const Vec3> targets;      ///< [vertices] read if fixed [m]
    double h;                      ///< [s] substep
    double end;                    ///< end of the substep as a fraction of the step [-]
    bool is_first;                 ///< first substep of the step
    View<const Particle> before;
    View<Particle> after; ///< in: start of the previous substep

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const Particle here = before[i];
        Vec3 force = Vec3::Zero();
        if (!first_entry.empty())
            force = bending_gradient(i, here, team);
        if (team.thread != 0 || !is_in_range)
            return;
        if (here.mobility == 0.0) {
            after[i] = here.at(start[i] + end * (targets[i] - start[i]));
            return;
        }
        const Vec3 old_velocity =
            is_first ? velocity[i] : Vec3((1.0 / h) * difference<double>(after[i], here));
        const Vec3 v = old_velocity + h * (acceleration[i] - here.mobility * force);
        after[i] = here.at(here.position() + h * v);
    }

private:
    /// (K x)_i; rows sum to zero, so differences replace positions. [N]
    template <typename Team>
    TOILE_HD Vec3 bending_gradient(int i, const Particle& here, const Team& team) const
    {
        Vec3 sum = Vec3::Zero();
        const int slice = i / SlicedRows::kRows, last = first_entry[slice + 1];
        for (int k = first_entry[slice] + i % SlicedRows::kRows * SlicedRows::kThreads + team.thread;
             k < last; k += kWarp)
            sum += double(entries[k].value) * difference<double>(here, before[entries[k].column]);
        for (int a = 0; a < 3; ++a)
            sum[a] = team.sum(1, sum[a]);
        return sum;
    }
};

/// ProjectStrains for one triangle.
template <typename T>
struct ProjectStrainItem {
    View<const StrainItem<T>> items; ///< of one colour
    garment::MembraneWeights weights;
    double h;             ///< [s] substep
    View<Particle> after; ///< [vertices]

    TOILE_HD void operator()(int k) const
    {
        const StrainItem<T> item = items[k];
        Particle corner[3];
        StrainTriangle<T> triangle;
        for (int c = 0; c < 3; ++c) {
            corner[c] = after[item.corner[c]];
            triangle.mobility[c] = T(corner[c].mobility);
        }
        triangle.edge1 = difference<T>(corner[0], corner[1]);
        triangle.edge2 = difference<T>(corner[0], corner[2]);
        for (int e = 0; e < 4; ++e)
            triangle.rest_inv(e / 2, e % 2) = item.rest_inv[e];
        triangle.area = item.area;

        const Mat3Of<T> moves = strain_moves<T>(triangle, weights, h);
        for (int c = 0; c < 3; ++c)
            after[item.corner[c]] = corner[c].at(corner[c].position() + moves.col(c).template cast<double>());
    }
};

/// ProjectCurvatures for one stencil.
template <typename T>
struct ProjectCurvatureItem {
    View<const CurvatureItem<T>> items;        ///< of one colour
    View<const CurvatureItemEntry<T>> entries; ///< of all colours
    double h;                                  ///< [s] substep
    View<Particle> after;                      ///< [vertices]

    TOILE_HD void operator()(int k) const
    {
        const CurvatureItem<T> item = items[k];
        const Particle first = after[entries[item.first].vertex];
        CurvatureConstraints<T> constraints;
        for (int j = item.first; j < item.first + item.count; ++j) {
            const Particle particle = after[entries[j].vertex];
            constraints.add(entries[j].weight, T(particle.mobility), difference<T>(first, particle));
        }
        constraints.project(item.stiffness, h);
        for (int j = item.first; j < item.first + item.count; ++j) {
            const Particle particle = after[entries[j].vertex];
            Vec3 position = particle.position();
            for (int r = 0; r < 3; ++r)
                position += ((T(particle.mobility) * entries[j].weight[r]) * constraints.multiplier(r))
                                .template cast<double>();
            after[entries[j].vertex] = particle.at(position);
        }
    }
};

/// Positions and velocities after the last substep.
struct EndParticle {
    View<const Particle> before, after;
    double h; ///< [s] substep
    View<Vec3> x, v;

    TOILE_HD void operator()(int i) const
    {
        x[i] = after[i].position();
        v[i] = (1.0 / h) * difference<double>(before[i], after[i]);
    }
};

} // namespace toile::research
