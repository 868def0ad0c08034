#pragma once

#include <memory>
#include <vector>

#include "core/pd/body.h"
#include "garment/energy/rest_shape.h"
#include "garment/energy/strain_limit_kernels.h"
#include "garment/energy/stretch_tension.h"

namespace toile {

/// Hard limit on the principal stretches of every triangle.
///
///   sigma_max(F_t) <= 1 + limit   for all t
///
/// Enforced after the step's minimisation by nonlinear Gauss-Seidel over the violating triangles: each is
/// moved, mass-weighted, to the closest edges with clamped singular values [Wang et al. 2010; projecting
/// after the step: Goldenthal et al. 2007]. They take turns colour by colour, where no two of a colour share
/// a vertex, so that a GPU can clamp a colour at once (DeviceStrainLimit) and do the same as the CPU. Sweeps
/// that end with a larger strain than they began with are undone. Inside H the limit would need weights that
/// stall every method built on a fixed H (docs/garment/strain_limit.md).
class StrainLimit : public StepProjection {
public:
    struct Settings {
        double limit = 0.06;     ///< [-] largest principal stretch minus one. Must be positive.
        double tolerance = 1e-3; ///< [-] excess over the limit that is left alone
        int max_sweeps = 100;    ///< an unreachable limit (pins too far apart) stops here
    };

    /// Sweeps that clear contacts too. Beyond them the limit goes before contact: cloth caught between
    /// colliders, where the two contradict each other, would never come to an end.
    static constexpr int kSweepsWithContact = 30;

    /// @throws InvalidInput naming `source` when the limit is not positive.
    StrainLimit(std::shared_ptr<const RestShape> rest, const Settings& settings, const std::string& source);

    /// Tells the tension of every minimiser from now on, before it is clamped. On a GPU DeviceBody tells it.
    void tell(std::shared_ptr<StretchTension> tension) { tension_ = std::move(tension); }

    void observe(View<const Vec3> x) override;
    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override;

    /// The parts of project(), for several cloths that contact between them moves too: look(), which is true
    /// where something violates the limit, keep(), then sweeps, each followed by a look, and end(), which
    /// goes back to what was kept where the sweeps have ended worse.
    bool look(View<const Vec3> x);
    void keep(View<const Vec3> x);
    void sweep(int number, View<Vec3> x, View<const double> inverse_masses);
    /// @param has_moved_elsewhere  not only triangles of the sweep have moved
    void look_again(View<const Vec3> x, bool has_moved_elsewhere);
    bool violates() const { return !violating_.empty(); } ///< by the last look
    void end(View<Vec3> x) const;

    /// Largest principal stretch minus one at x, of slivers too [-].
    double max_strain(View<const Vec3> x) const;

    const RestShape& rest() const { return *rest_; }
    const Settings& settings() const { return settings_; }
    LimitedTriangles triangles() const;
    int colour_count() const { return int(first_of_colour_.size()) - 1; }
    View<const int> triangles_of(int colour) const; ///< ascending

private:
    void look_at_everything(View<const Vec3> x);
    void look_around_violating(View<const Vec3> x);

    std::shared_ptr<const RestShape> rest_;
    Settings settings_;
    std::shared_ptr<StretchTension> tension_;
    std::vector<StretchLimits> limits_; ///< of triangles, of slivers: those are left to the membrane
    std::vector<int> kind_;             ///< [triangles] into limits_
    bool has_slivers_ = false;
    std::vector<int> order_;              ///< [triangles] colour by colour
    std::vector<int> first_of_colour_{0}; ///< [colours + 1] into order_
    std::vector<int> rank_;               ///< [triangles] places in order_
    std::vector<unsigned char> violates_; ///< [triangles]
    std::vector<int> violating_;          ///< triangles as they come in order_
    std::vector<Vec3> before_;            ///< [vertices] positions before the first sweep [m]
};

} // namespace toile
