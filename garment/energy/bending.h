#pragma once

#include <memory>

#include "core/pd/energy/energy.h"
#include "garment/energy/by_fabric.h"
#include "garment/energy/curvature_stencil.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Resistance of cloth to bending, quadratic in the positions and therefore constant in H.
///
///   W = sum_t A_t/2 ( D_u |x_uu|^2 + D_v |x_vv|^2 + 2 sqrt(D_u D_v) |x_uv|^2 )
///
/// x_uu, x_uv, x_vv are second derivatives of the position in material axes on triangle t
/// (curvature_stencil.h). Cloth barely stretches, so they are the curvatures times the unit normal and W is
/// the plate energy with rigidities D_u, D_v [N m] and zero Poisson ratio. [Bergou et al. 2006] use the same
/// isometry argument on hinges; a hinge's prefactor depends on the mesh (up to a factor 3), this operator
/// converges on any triangulation.
///
/// The rest shape is flat: cloth is cut from a plane. Across hinges it does not bend at all, and no moment
/// acts there: the folds of FoldLines alone hold them.
class Bending : public Energy {
public:
    struct Settings {
        double warp = 5e-6; ///< [N m] D_u: rigidity when the warp bends. Not negative.
        double weft = 5e-6; ///< [N m] D_v
    };

    /// @param hinges  inner edges, as indices into Topology::edges
    /// @throws InvalidInput naming `source` and a rigidity that is negative or not finite.
    Bending(const std::shared_ptr<const RestShape>& rest, const ByFabric<Settings>& settings,
            const std::string& source, const std::vector<int>& hinges = {});

    /// Leaves bending out of H if it is far below the diagonal of the membrane's part [vertices] [N/m] at
    /// every vertex. The membrane's majoriser then covers bending at least ten times over. Without the second
    /// ring of neighbours L has a third of the entries (docs/theory/bending.md).
    /// @return true if bending is left out
    bool leave_to(View<const double> membrane_diagonal);

    std::string_view name() const override { return "garment/bending"; }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets& S) const override; ///< K, in H or not
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

    /// K [vertices x vertices] [N/m]: W = 1/2 x^T K x for x, y and z alike; rows sum to zero.
    const SparseMatrix& matrix() const { return K_; }

    /// Contribution of one triangle to W: 1/2 sum_k stiffness_k |row_k x|^2 over the rows of the stencil.
    struct Term {
        CurvatureStencil stencil;
        Vec3 stiffness; ///< [N m^3] A_t (D_u, 2 sqrt(D_u D_v), D_v), less for slivers
    };

    /// Contributions of all triangles with neighbours; their sum is K.
    /// @throws InvalidInput as the constructor does.
    static std::vector<Term> terms(const RestShape& rest, const ByFabric<Settings>& settings,
                                   const std::string& source, const std::vector<int>& hinges = {});

private:
    SparseMatrix K_;
    bool in_hessian_ = true;
    std::vector<double> vertex_energy_;
};

} // namespace toile::garment
