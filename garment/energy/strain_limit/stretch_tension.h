#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/by_fabric.h"
#include "garment/energy/rest_shape.h"
#include "garment/energy/strain_limit/stretch_tension_kernels.h"
#include "garment/energy/stretch_curvature.h"

namespace toile::garment {

/// Tension of the triangles that have reached their strain limit: the augmented Lagrangian of
///
///   sigma_max(F_t) <= 1 + limit     for all t
///
/// With P the projection of a matrix onto that convex set and T_t the tension stored at the previous step,
///
///   W = sum_t k A_t/2 |G - P(G)|^2,   G = F_t + T_t / k;      afterwards  T_t = k (G - P(G))
///
/// [Hestenes 1969, Powell 1969]. The global solve of the minimisation propagates the tension through the
/// whole cloth at once, and the tension is stored between steps. After a few steps almost nothing remains for
/// the clamping of single triangles (StrainLimit). T_t rotates with its triangle. It is not part of H: only
/// triangles near the limit are evaluated, and along the stiffer yarn their curvature at most doubles.
///
/// The tension has one owner: this object, or after add_to() DeviceStretchTension. In the latter case
/// begin_step() and remember() do nothing here, since the body on the GPU calls its own; forget() still
/// reaches it.
class StretchTension : public Energy {
public:
    struct Settings {
        double limit = 0.06;      ///< [-] as in StrainLimit
        double stiffness = 250.0; ///< [N/m] k, the larger of the membrane's two
        double max_tension = 1.0; ///< [-] of k: bounds the force if a limit cannot be met; 0: none is stored
        double watched = 0.7;     ///< [-] of the limit, from which on a triangle is evaluated during a step

        /// A stiff elastic limit, for Newton's method: every triangle is evaluated, and nothing is stored.
        /// Stored tension lags behind the motion by a step, which adds energy to cloth that swings back from
        /// its limit.
        /// @param stiffness  [N/m] the larger of the membrane's two
        /// @param load       [N/m] over the width of the cloth, such as its weight
        static Settings elastic(double limit, double stiffness, double load)
        {
            return {limit, std::max(kElastic * stiffness, load / kExcess), 0.0,
                    -std::numeric_limits<double>::infinity()};
        }
        /// Stiffness beyond the limit relative to the membrane's [-]: cloth under a load that would stretch
        /// it to twice its limit exceeds the limit by a fiftieth.
        static constexpr double kElastic = 50.0;
        /// Excess over the limit under the load [-], however soft the membrane is.
        static constexpr double kExcess = 0.005;
    };

    StretchTension(std::shared_ptr<const RestShape> rest, const ByFabric<Settings>& settings);

    std::string_view name() const override { return "garment/stretch_tension"; }
    void add_hessian(Triplets&) const override {}
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    bool find_entries(SparseWindow S, BlockWindow K) override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

    /// Selects the triangles near their limit at x [vertices] and rotates their tension with them. The owner
    /// calls it before Body::step.
    void begin_step(View<const Vec3> x);

    /// Resets the tension of earlier steps, for cloth that has been repositioned.
    void forget();

    /// Stores the tension at the minimiser x. StrainLimit calls it before it clamps.
    void remember(View<const Vec3> x);

    const RestShape& rest() const { return *rest_; }
    TensionTriangles triangles() const;
    int forgotten() const { return forgotten_; } ///< number of forget() calls

private:
    std::shared_ptr<const RestShape> rest_;
    /// Of triangles and slivers of the first fabric, then of the next; slivers are left to the membrane.
    std::vector<TensionLimits> limits_;
    std::vector<int> kind_; ///< [triangles] into limits_
    bool is_on_device_ = false;
    int forgotten_ = 0;
    std::vector<Mat2> tension_;                      ///< [triangles] T_t / k in material axes
    std::vector<unsigned char> near_;                ///< [triangles]
    std::vector<Mat32> rotated_tension_;             ///< [triangles] T_t / k at this step, if near
    std::vector<int> taut_;                          ///< triangles near their limit, ascending
    std::vector<MembraneResponse<double>> response_; ///< [taut] scratch
    std::vector<CornerPositions> position_;          ///< [3 * triangles]
    std::vector<unsigned char> exceeds_;             ///< [taut] scratch
};

} // namespace toile::garment
