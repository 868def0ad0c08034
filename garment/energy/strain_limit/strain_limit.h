#pragma once

#include <memory>
#include <vector>

#include "core/pd/step/body.h"
#include "garment/energy/by_fabric.h"
#include "garment/energy/rest_shape.h"
#include "garment/energy/strain_limit/strain_limit_kernels.h"
#include "garment/energy/strain_limit/stretch_tension.h"

namespace toile::garment {

/// Strain beyond its limit that counts as kept [-]: the limit is an elastic energy.
inline constexpr double kStrainMargin = 0.05;

/// Hard limit on the principal stretches of every triangle.
///
///   sigma_max(F_t) <= 1 + limit   for all t
///
/// Enforced after the step's minimisation by nonlinear Gauss-Seidel over the violating triangles. Each moves,
/// mass-weighted, to the closest edges with clamped singular values [Wang et al. 2010; projecting after the
/// step: Goldenthal et al. 2007]. Triangles are ordered by colour; no two of a colour share a vertex. A GPU
/// therefore clamps a colour at once (DeviceStrainLimit), with the same result as the CPU. Sweeps that end
/// with a larger strain than they began with are undone. Inside H the limit would need weights that stall
/// every method built on a fixed H (docs/theory/strain_limit.md).
class StrainLimit : public StepProjection {
public:
    struct Settings {
        double limit = 0.06;     ///< [-] maximum principal stretch minus one. Must be positive.
        double tolerance = 1e-3; ///< [-] excess over the limit that is not corrected
        int max_sweeps = 100;    ///< bound for an unreachable limit (pins too far apart)
    };

    /// Sweeps that also clear contacts. Beyond them the limit takes precedence over contact. Cloth caught
    /// between colliders, where the two contradict each other, would otherwise never converge.
    static constexpr int kSweepsWithContact = 30;

    /// @throws InvalidInput naming `source` if the limit is not positive.
    StrainLimit(std::shared_ptr<const RestShape> rest, const ByFabric<Settings>& settings,
                const std::string& source);

    /// Sets the tension that observe() updates at every minimiser before clamping. On a GPU DeviceBody does
    /// so.
    void set_tension(std::shared_ptr<StretchTension> tension) { tension_ = std::move(tension); }

    void observe(View<const Vec3> x) override;
    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override;

    /// Parts of project(), for several cloths that are moved by contact between them. find_violations() is
    /// true if something violates the limit; keep() saves positions. Sweeps follow, each with an update.
    /// end() restores the saved positions if the sweeps made the strain worse.
    bool find_violations(View<const Vec3> x);
    void keep(View<const Vec3> x);
    void sweep(int number, View<Vec3> x, View<const double> inverse_masses);
    /// @param has_moved_elsewhere  true if vertices outside the swept triangles have moved
    void update_violations(View<const Vec3> x, bool has_moved_elsewhere);
    bool violates() const { return !violating_.empty(); } ///< according to the last search
    void end(View<Vec3> x) const;

    /// Maximum principal stretch minus one at x, including slivers [-].
    double max_strain(View<const Vec3> x) const;

    /// Triangles, slivers apart, that exceed the limit at x by more than `margin` [-].
    struct Excess {
        int count = 0;
        int triangle = -1; ///< that with the largest strain, of equal ones the first
        double strain = 0.0;
        int held = 0; ///< not counted: triangles whose corners are all held
        int first_held = -1;
    };
    /// @param held  [vertices] 1: moved by an attachment; empty: none is
    Excess excess(View<const Vec3> x, double margin, View<const unsigned char> held) const;

    const RestShape& rest() const { return *rest_; }
    double least_limit() const { return least_limit_; } ///< [-] of all fabrics
    int max_sweeps() const { return max_sweeps_; }      ///< of all fabrics
    LimitedTriangles triangles() const;
    int colour_count() const { return int(first_of_colour_.size()) - 1; }
    View<const int> triangles_of(int colour) const; ///< ascending

private:
    void check_all(View<const Vec3> x);
    void check_near_violating(View<const Vec3> x);

    std::shared_ptr<const RestShape> rest_;
    double least_limit_ = 0.0;
    int max_sweeps_ = 0;
    std::shared_ptr<StretchTension> tension_;
    /// Of triangles and slivers of the first fabric, then of the next; slivers are left to the membrane.
    std::vector<StretchLimits> limits_;
    std::vector<int> kind_; ///< [triangles] into limits_
    bool has_slivers_ = false;
    std::vector<int> order_;              ///< [triangles] colour by colour
    std::vector<int> first_of_colour_{0}; ///< [colours + 1] into order_
    std::vector<int> rank_;               ///< [triangles] positions in order_
    std::vector<unsigned char> violates_; ///< [triangles]
    std::vector<int> violating_;          ///< triangles in the sequence of order_
    std::vector<Vec3> before_;            ///< [vertices] positions before the first sweep [m]
};

} // namespace toile::garment
