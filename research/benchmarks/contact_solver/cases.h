#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/contact/contact.h"
#include "core/pd/energy/system.h"

namespace toile::research::contact_solver {

enum class Kind {
    Floor,    ///< a sheet on a floor: independent vertices
    Disjoint, ///< two sheets in contact at isolated points: four vertices each, none shared
    Stack,    ///< five sheets on each other: every vertex in several pairs
    Sticking, ///< Stack with sticking friction
};

/// One linear system (H + dH) z = g of a step: cloth pressed 0.5 to 1.5 mm too far together. Sheets of 1 m x
/// 1 m, irregular, 1e3 N/m, 0.2 kg/m^2, dt 1/120 s.
class Case {
public:
    static constexpr double kDt = 1.0 / 120.0; // [s]

    /// @param vertices   approximate total
    /// @param stiffness  of contact relative to diag(H), Contact::Settings::stiffness
    Case(Kind kind, int vertices, double stiffness);

    const System& system() const { return *system_; }
    const collision::Contact& contact() const { return *contact_; } ///< frozen
    View<const Vec3> forces() const { return g_; }                  ///< g: contact's [N]
    int term_count() const { return term_count_; }

private:
    void make_sheets(Kind kind, int vertices);
    void make_system();
    void press(Kind kind, double stiffness);

    std::vector<Triangle> triangles_;
    std::vector<Vec2> uv_;          ///< [m]
    std::vector<Vec3> x_, pressed_; ///< [vertices] start and prediction [m]
    std::vector<int> sheet_of_;     ///< [vertices]
    std::vector<unsigned char> fixed_;
    collision::ShapeCollider floor_;
    std::unique_ptr<System> system_;
    std::unique_ptr<collision::Contact> contact_;
    std::vector<Vec3> g_;
    int term_count_ = 0;
};

} // namespace toile::research::contact_solver
