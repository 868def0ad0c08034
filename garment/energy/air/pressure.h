#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Overpressure [Pa] on the side of a cloth that its normals point away from: air in a cushion.
///
///   W = -p (V(x) - g . x)
///
/// V is the volume that the triangles enclose, by the divergence theorem. Each loop of border edges is closed
/// by a cap: a fan about its centroid. g is the gradient of V by the caps at the start of the step, so their
/// force is taken off again. What remains at the start of the step is p times area and normal of each
/// triangle, a third at each corner. Closed cloth has no caps; its force is exact everywhere and sums up to
/// zero. For cloth with a border no energy exists whose force is exact everywhere: that force can do work in
/// a cycle. It is exact here at the start of the step, and so at rest.
///
/// The second derivative of -p V is indefinite, without any part on the diagonal. It is left out: the
/// membrane's tension, which balances the pressure, is larger in all modes but rigid ones.
class Pressure : public Energy {
public:
    explicit Pressure(std::shared_ptr<const RestShape> rest);

    /// Begins a step at x [vertices] with an overpressure [Pa]. Before the first one there is none.
    void begin_step(View<const Vec3> x, double pressure);

    /// Volume that triangles and caps enclose [m^3]; negative if normals point inwards.
    double volume(View<const Vec3> x);

    bool is_closed() const { return caps_.empty(); } ///< without border edges

    std::string_view name() const override { return "garment/pressure"; }
    void add_hessian(Triplets&) const override {}
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;

    double overpressure() const { return pressure_; } ///< [Pa] of the last step

private:
    /// Fan over a border loop.
    struct Cap {
        std::vector<std::array<int, 2>> edges; ///< from and to, as the cloth's triangles run along them
        std::vector<int> vertices;             ///< of the edges, ascending

        Vec3 centroid(View<const Vec3> x) const;
    };
    std::vector<Cap> caps_of_borders() const;
    double cap_volume(const Cap& cap, View<const Vec3> x) const;
    template <typename Add>
    static void for_each_cap_gradient(const Cap& cap, View<const Vec3> x, const Add& add);

    std::shared_ptr<const RestShape> rest_;
    std::vector<Cap> caps_;
    double pressure_ = 0.0;
    Vec3 origin_ = Vec3::Zero();           ///< [m] near the cloth, against rounding
    std::vector<Vec3> start_cap_gradient_; ///< [vertices] g [m^2]; empty without caps
    std::vector<Vec3> corner_gradient_;    ///< [triangles] of V by each corner [m^2]
    std::vector<double> triangle_volume_;  ///< [triangles] [m^3]
};

} // namespace toile::garment
