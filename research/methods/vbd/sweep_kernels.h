#pragma once

#include "core/linear/sliced_rows.h"
#include "research/methods/particle.h"
#include "research/methods/vbd/followed_acceleration.h"
#include "research/methods/vbd/membrane_corner.h"
#include "research/methods/vbd/sweep_table.h"

namespace toile::research {

/// Kernels of VertexBlockDescent on a GPU.

/// Computes q* and the initial iterate of the sweeps; fixed vertices move to their targets.
struct BeginSweeps {
    View<const Vec3> x, v;         ///< [vertices] [m], [m/s]
    View<const Vec3> v_before;     ///< [vertices] of the previous step [m/s]; empty: start at q*
    View<const Vec3> acceleration; ///< [vertices] [m/s^2]
    View<const Vec3> targets;      ///< [vertices] read if fixed [m]
    View<const double> mobility;   ///< [vertices] [1/kg] 0 if fixed
    double dt;                     ///< [s]
    View<Particle> particles;      ///< [vertices] out
    View<Vec3> prediction;         ///< [vertices] out [m]
    View<Vec3> last, before_last;  ///< [vertices] out, or empty without acceleration [m]

    TOILE_HD void operator()(int i) const
    {
        const Vec3 coasting = x[i] + dt * v[i];
        Vec3 start = targets[i];
        prediction[i] = targets[i];
        if (mobility[i] > 0.0) {
            prediction[i] = coasting + dt * dt * acceleration[i];
            start = prediction[i];
            if (!v_before.empty())
                start = coasting + dt * dt * followed(acceleration[i], (1.0 / dt) * (v[i] - v_before[i]));
        }
        particles[i] = Particle(start, mobility[i]);
        if (!last.empty())
            last[i] = before_last[i] = start;
    }
};

/// Gradient of the bending energy at the start of a sweep, by a team of threads per vertex.
struct LagBending {
    View<const int> first;        ///< [slices + 1] of SlicedRows
    View<const RowEntry> entries; ///< of K [N/m]
    View<const Particle> particles;
    View<PaddedVec3> gradient; ///< [vertices] out [N]

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const Particle here = particles[i];
        const int slice = i / SlicedRows::kRows, last = first[slice + 1];
        Vec3 sum = Vec3::Zero();
        for (int k = first[slice] + i % SlicedRows::kRows * SlicedRows::kThreads + team.thread; k < last;
             k += kWarp)
            sum += double(entries[k].value) * difference<double>(here, particles[entries[k].column]);
        for (int a = 0; a < 3; ++a)
            sum[a] = double(team.sum(1, float(sum[a])));
        if (team.thread == 0 && is_in_range)
            gradient[i] = padded(sum);
    }
};

/// DescendVertices for one vertex, by a team of threads that share its triangles and its row of K.
template <typename T>
struct DescendVertex {
    View<const SweepItem<T>> items; ///< of one colour
    View<const SweepTriangle<T>> triangles;
    View<const SweepBend<T>> bends;
    View<const PaddedVec3> lagged; ///< [vertices] gradient of bending at the start of the sweep [N]; or empty
    garment::MembraneWeights weights;
    double dt;                   ///< [s]
    View<const Vec3> prediction; ///< [vertices] [m]
    View<Particle> particles;    ///< [vertices] in and out

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range) const
    {
        const SweepItem<T> item = items[k];
        const Particle self = particles[item.vertex];
        Vec3Of<T> gradient(T(0.0), T(0.0), T(0.0));
        Symmetric3<T> hessian(T(0.0));
        if (team.thread == 0)
            add_inertia(item, self, gradient, hessian);
        add_neighbours(item, self, team, gradient, hessian);
        for (int a = 0; a < 3; ++a)
            gradient(a) = team.sum(1, gradient(a));
        T* const entries[] = {&hessian.xx, &hessian.yy, &hessian.zz, &hessian.xy, &hessian.xz, &hessian.yz};
        for (T* const entry : entries)
            *entry = team.sum(1, *entry);
        if (team.thread != 0 || !is_in_range || self.mobility == 0.0)
            return;
        const Vec3Of<T> step = hessian.solve(gradient);
        particles[item.vertex] = self.at(self.position() - step.template cast<double>());
    }

private:
    TOILE_HD void add_inertia(const SweepItem<T>& item, const Particle& self, Vec3Of<T>& gradient,
                              Symmetric3<T>& hessian) const
    {
        const T inertia = item.mass * T(1.0 / (dt * dt));
        gradient += inertia * (self.position() - prediction[item.vertex]).template cast<T>();
        hessian.add_identity(inertia + item.bending);
        if (!lagged.empty())
            for (int a = 0; a < 3; ++a)
                gradient(a) += T(lagged[item.vertex][a]);
    }

    /// Adds membrane and bending terms. The vertex is corner 0 of each triangle.
    template <typename Team>
    TOILE_HD void add_neighbours(const SweepItem<T>& item, const Particle& self, const Team& team,
                                 Vec3Of<T>& gradient, Symmetric3<T>& hessian) const
    {
        for (int k = item.first_bend + team.thread; k < item.bend_end; k += Team::kThreads)
            gradient += bends[k].stiffness * difference<T>(self, particles[bends[k].vertex]);
        for (int k = item.first_triangle + team.thread; k < item.triangle_end; k += Team::kThreads) {
            const SweepTriangle<T> triangle = triangles[k];
            Mat2Of<T> rest_inv;
            for (int e = 0; e < 4; ++e)
                rest_inv(e / 2, e % 2) = triangle.rest_inv[e];
            add_first_corner<T>(difference<T>(self, particles[triangle.corner1]),
                                difference<T>(self, particles[triangle.corner2]), rest_inv, triangle.area,
                                weights, gradient, hessian);
        }
    }
};

/// x^(n) = omega_n (x - x^(n-2)) + x^(n-2)   [Chen et al. 2024, section 3.8]
struct AccelerateSweep {
    double omega; ///< [-]
    View<Particle> particles;
    View<Vec3> last, before_last; ///< [vertices] [m]

    TOILE_HD void operator()(int i) const
    {
        const Particle here = particles[i];
        const Vec3 from = before_last[i], position = from + omega * (here.position() - from);
        particles[i] = here.at(position);
        before_last[i] = last[i];
        last[i] = position;
    }
};

/// Positions and velocities after the last sweep.
struct EndSweeps {
    View<const Particle> particles;
    double dt; ///< [s]
    View<Vec3> x, v, v_before;

    TOILE_HD void operator()(int i) const
    {
        const Vec3 position = particles[i].position();
        v_before[i] = v[i];
        v[i] = (position - x[i]) / dt;
        x[i] = position;
    }
};

} // namespace toile::research
