#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"
#include "volume/energy/elastic_kernels.h"
#include "volume/energy/rest_tets.h"

namespace toile::volume {

/// Isotropic material of a solid.
struct ElasticMaterial {
    double young = 1e5;   ///< [Pa] positive
    double poisson = 0.3; ///< [-] from 0 to 0.49

    /// mu = E / (2 (1 + nu)), lambda = E nu / ((1 + nu) (1 - 2 nu))
    /// @throws InvalidInput naming `source` and the value outside its range
    Lame lame(const std::string& source) const;
};

/// Resistance of a solid to strain and to change of volume, as a Projective Dynamics energy.
///
///   W = sum_t V_t [ mu |F - R|^2 + lambda/2 (det F - 1)^2 ]
///
/// F maps rest edges of tetrahedron t to current edges, R is the closest rotation [Stomakhin et al. 2012, eq.
/// 7]. For small strains it is linear elasticity with Lame's constants mu and lambda. Rigid motion costs
/// nothing; a tetrahedron that is turned inside out has a finite energy, which turns it back.
class ElasticSolid : public Energy {
public:
    /// @param lame  [tets]
    ElasticSolid(std::shared_ptr<const RestTets> rest, std::vector<Lame> lame);

    std::string_view name() const override { return "volume/elastic"; }

    /// The modulus of pressure waves, 2 mu + lambda, in all directions: the largest curvature of a wave in
    /// the material at rest.
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    bool find_entries(SparseWindow S, BlockWindow K) override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

private:
    /// Eight tetrahedra.
    struct Block {
        Mat3Of<Lanes> rest_inv; ///< inverse rest edge matrix [1/m]
        Lanes volume;           ///< [m^3]
        LameOf<Lanes> lame;
    };
    Mat3Of<Lanes> deformation_gradients(View<const Vec3> x, int block) const;

    std::shared_ptr<const RestTets> rest_;
    std::vector<Lame> lame_; ///< [tets]
    std::vector<Block> blocks_;
    std::vector<Mat3> corner_gradient_;            ///< [tets] scratch: columns dW/dx1, dW/dx2, dW/dx3
    std::vector<double> energy_;                   ///< [tets] scratch
    std::vector<ElasticBlocks<double>> curvature_; ///< [tets] scratch
    std::vector<std::array<int, 4>> position_;     ///< [4 tets] of a corner's blocks in its row
};

} // namespace toile::volume
