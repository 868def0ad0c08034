#pragma once

#include <array>
#include <vector>

#include "core/mesh/topology.h"
#include "core/pd/energy/energy.h"
#include "garment/energy/bend_damping_kernels.h"
#include "garment/energy/bending.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Internal friction of bending cloth: a potential over one step of the change of each fold, so rigid motion
/// costs nothing and forces have neither sum nor torque.
///
///   D = sum_e  B_e tau / (2 h) ds_e^2 + m |e| f(|ds_e|),    B_e = 3 D |e|^2 / (A_0 + A_1)
///
/// The viscous part, with time tau, is the material's loss in fast motion. The dry part is the moment per
/// width m that yarns hold by friction; it brings cloth to rest, which viscosity alone does not
/// (docs/theory/damping.md). f is smooth below a rate of the curvature.
///
/// Its part of Newton's matrix is positive semi-definite: exact along the normal of flat cloth, and equal in
/// all directions, where the membrane is far stiffer.
class BendDamping : public Energy {
public:
    struct Settings {
        Bending::Settings rigidity; ///< [N m]
        double time = 0.03;         ///< [s] tau. Not negative.
        double friction = 12.0;     ///< [1/m] m / D: the curvature that friction holds. Not negative.

        bool is_active() const { return time > 0.0 || friction > 0.0; }
    };

    /// @param hinges  edges without friction, as of Bending: indices into Topology::edges
    /// Edges between two fabrics have the mean of their settings.
    /// @throws InvalidInput naming `source` and a setting that is negative or not finite.
    BendDamping(const RestShape& rest, const ByFabric<Settings>& settings, const std::string& source,
                const std::vector<int>& hinges = {});

    /// Begins a step of dt seconds at x [vertices].
    void begin_step(View<const Vec3> x, double dt);

    std::string_view name() const override { return "garment/bend_damping"; }
    void add_hessian(Triplets&) const override {}
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets& S) const override; ///< zeros: the pattern
    bool find_entries(SparseWindow S, BlockWindow K) override;
    void add_isotropic_curvature(View<const Vec3> x, SparseWindow S) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

private:
    using Forces = std::array<Vec3, 4>;

    Fold<Lanes> folds(View<const Vec3> x, int block) const;
    HingeResponse<Lanes> response(const Fold<Lanes>& fold, int block) const;

    std::vector<Hinge> hinges_;
    Incidence slots_of_vertex_;                ///< 4 * hinge + slot
    double dt_ = 0.0;                          ///< [s] of the step, 0 before the first
    std::vector<HingeStart> start_;            ///< [hinges]
    std::vector<Forces> force_;                ///< [hinges] scratch [N]
    std::vector<double> energy_, stiffness_;   ///< [hinges] scratch [J], [N m]
    std::vector<std::array<int, 4>> position_; ///< [slots] of the hinge's vertices in the row
};

} // namespace toile::garment
