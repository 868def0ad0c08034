#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/contact/contact.h"
#include "core/pd/energy/leading_active_set.h"
#include "core/pd/energy/system.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::research::contact_solver {

enum class Kind {
    Floor,    ///< a sheet on a floor: independent vertices
    Disjoint, ///< two sheets in contact at isolated points: four vertices each, none shared
    Stack,    ///< five sheets on each other: every vertex in several pairs
    Sticking, ///< Stack with sticking friction
    Bars,     ///< two bars of tetrahedra on each other
};

/// One linear system (H + dH) z = g of a step: bodies pressed 0.5 to 1.5 mm too far together, dt 1/120 s.
/// Sheets of 1 m x 1 m, irregular, 1e3 N/m, 0.2 kg/m^2; bars of 0.3 m x 0.1 m x 0.1 m, 1e6 Pa, 1000 kg/m^3.
class Case {
public:
    static constexpr double kDt = 1.0 / 120.0; // [s]

    /// @param vertices   approximate total
    /// @param stiffness  of contact relative to diag(H), Contact::Settings::stiffness
    Case(Kind kind, int vertices, double stiffness);

    const System& system() const { return *system_; }
    const FrozenHessian& contact() const { return *surface_contact_; }
    View<const Vec3> forces() const { return g_; } ///< g: contact's [N]
    int term_count() const { return term_count_; }

    /// Undeformed bodies, apart from each other: sheets in the plane z = 0, or tetrahedra.
    View<const Vec3> rest() const { return rest_; } ///< [vertices] [m]
    View<const Triangle> triangles() const { return triangles_; }
    View<const volume::Tet> tets() const { return tets_; } ///< empty for sheets

private:
    void make_sheets(Kind kind, int vertices);
    void make_bars(int vertices);
    std::shared_ptr<Energy> make_energy(std::vector<double>& masses) const;
    void make_system();
    void press(Kind kind, double stiffness);

    std::vector<Triangle> triangles_;
    std::vector<volume::Tet> tets_;
    std::vector<Vec3> rest_;        ///< [vertices] [m]
    std::vector<Vec3> x_, pressed_; ///< [vertices] start and prediction [m]
    int surface_count_ = 0;         ///< vertices on surfaces, which come first
    std::vector<unsigned char> fixed_;
    collision::ShapeCollider floor_;
    std::unique_ptr<System> system_;
    std::unique_ptr<collision::Contact> contact_;       ///< of the surfaces
    std::unique_ptr<LeadingActiveSet> surface_contact_; ///< likewise, among all vertices
    std::vector<Vec3> g_;
    int term_count_ = 0;
};

} // namespace toile::research::contact_solver
