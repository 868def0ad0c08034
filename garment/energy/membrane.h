#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/membrane_lanes.h"
#include "garment/energy/membrane_settings.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Resistance of woven cloth to in-plane stretch and shear, as a Projective Dynamics energy.
///
///   W = sum_t A_t/2 [ (k_u - 2G) (|F u| - 1)^2 + (k_v - 2G) (|F v| - 1)^2 + 2G |F - R|^2 ]
///
/// F maps rest edges of triangle t to current edges, u and v are warp and weft, R is the isometry closest to
/// F [Bouaziz et al. 2014, eq. 7]. Pulling along the warp meets Young's modulus k_u, along the weft k_v, and
/// a simple shear gamma costs G/2 gamma^2 per area. Poisson's ratio is zero: woven yarns slide past each
/// other. Rigid motion costs nothing; bending is a separate energy (bending.h).
///
/// Woven cloth also resists a change of strain: see viscous_response(). Between begin_step() and the next one
/// the potential over that step is part of W.
class Membrane : public Energy {
public:
    using Settings = MembraneSettings;

    /// @param stiffness  [triangles] factor on the three stiffnesses [-]; empty: 1, as a GPU needs it
    /// @throws InvalidInput naming `source` and the setting outside its range.
    Membrane(std::shared_ptr<const RestShape> rest, const Settings& settings, const std::string& source,
             std::vector<double> stiffness = {});

    std::string_view name() const override { return "garment/membrane"; }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    bool find_entries(SparseWindow S, BlockWindow K) override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

    /// Begins a step of dt seconds at x [vertices] for the viscosity.
    void begin_step(View<const Vec3> x, double dt);

    /// Weights of the three terms above [N/m].
    const MembraneWeights& weights() const { return weights_; }

private:
    /// Rest area times the factor on the stiffness [m^2].
    double weighted_area(size_t t) const
    {
        return stiffness_.empty() ? rest_->areas[t] : stiffness_[t] * rest_->areas[t];
    }
    ViscousWeights viscous_weights(double dt) const; ///< of a step of dt seconds
    ViscousStep viscosity() const { return {viscous_, viscous_share_, start_}; }

    std::shared_ptr<const RestShape> rest_;
    Settings settings_;
    std::vector<double> stiffness_;
    MembraneWeights weights_;
    std::vector<Mat2Of<Lanes>> rest_inv_; ///< [blocks of triangles]
    std::vector<Lanes> area_;             ///< [blocks of triangles] weighted
    ViscousWeights viscous_;
    std::vector<Lanes> viscous_share_;      ///< [blocks of triangles] 0 for slivers
    std::vector<GreenStrain<Lanes>> start_; ///< [blocks of triangles] strain at the start of the step
    std::vector<Mat32> corner_gradient_;
    std::vector<double> triangle_energy_;
    std::vector<StretchCurvature> curvature_; ///< [triangles] scratch
    std::vector<CornerPositions> position_;   ///< [3 * triangles]
};

} // namespace toile::garment
