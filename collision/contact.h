#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "collision/contact_energy.h"
#include "collision/detect.h"
#include "core/pd/active_set_energy.h"

namespace toile {

/// What one cloth may touch: exactly one of mesh and shape is set. Borrowed; moved by their owner before each
/// step.
struct ContactPartner {
    const MeshCollider* mesh = nullptr;
    const ShapeCollider* shape = nullptr;
    double friction = 0.3; ///< [-] Coulomb coefficient
};

/// Contact of one cloth with avatars and shapes during a step: finds pairs, keeps their energy, looks again
/// when the cloth has slid away from where they were found, and remembers friction from step to step.
class Contact : public ActiveSetEnergy {
public:
    /// Fastest surface that cloth is carried along with [m/s]. A body that jumps further in a step has been
    /// replaced, not moved: taking cloth along would shoot it away.
    static constexpr double kMaxCarrySpeed = 20.0;

    struct Settings {
        double gap = 0.002; ///< [m] distance kept between the cloth's middle surface and the collider

        /// [-] Stiffness of a pair relative to diag(H) at its vertices. Above 25 PCG slows down; at 1 a
        /// resting vertex sinks by micrometres, far less than the gap.
        double stiffness = 2.0;

        /// [m/s] Speed at which cloth found inside a collider is brought out. Bounds the force on cloth
        /// trapped between body parts and after a collider jumped.
        double recovery_speed = 1.0;

        bool face_vertex = true; ///< see DetectSettings
        bool edge_edge = true;
    };

    /// @param triangles  [triangles] of the cloth
    /// @param positions  [vertices] start positions [m]
    Contact(View<const Triangle> triangles, View<const Vec3> positions, std::vector<ContactPartner> partners,
            const Settings& settings);

    void begin_step(const StepStart& start) override;
    bool make_feasible(View<Vec3> x) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const override;
    bool activate(View<const Vec3> x) override;
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override;
    View<const Mat3> diagonal_blocks() const override { return energy_.diagonal_blocks(); }
    bool revise(View<const Vec3> x) override;
    void clear(View<Vec3> x, View<Vec3> v) override;
    void resolve(View<Vec3> x, View<Vec3> v) override;
    void end_step(View<const Vec3> x) override;

    /// Drops what earlier steps left: cloth that was put elsewhere touches nothing it knows.
    void forget();

    const ContactEnergy& energy() const { return energy_; }
    int active_count() const { return active_count_; } ///< pairs that push, after end_step()
    double min_gap() const { return min_gap_; }        ///< [m] smallest distance of a pair, after end_step()

private:
    /// Identity of a pair over time: kind, collider, cloth vertices.
    using Key = std::tuple<ContactKind, int, int, int, int>;

    /// What a pair hands to its successor.
    struct Memory {
        Vec3 normal;         ///< unit
        double normal_force; ///< [N]
        Vec3 stick;          ///< [m] elastic part of the slip
    };

    /// The surface point nearest to a cloth vertex.
    struct Nearest {
        int collider = -1; ///< -1: none near
        int feature = -1;
        double gap = 0.0;          ///< [m]
        Vec3 point = Vec3::Zero(); ///< [m]
    };

    void carry_with_colliders();
    void detect(View<const Vec3> at, double radius);
    ContactTerm make_term(const ContactPair& pair) const;
    Vec3 at_start(const ContactPair& pair) const;
    bool is_carried(const Vec3& motion) const;
    template <typename Slip>
    void remember(const Slip& slip);
    bool update_normal_forces(View<const Vec3> x);
    bool slid_away(View<const Vec3> x, double trust) const;
    double deepest(View<const Vec3> x) const;
    double leverage_of(const ContactPair& pair) const;
    bool push(const ContactPair& pair, const Vec3& move, View<Vec3> field) const;
    double clearance_of(const ContactPair& pair) const;
    Vec3 surface_velocity(const ContactPair& pair) const;
    void stop_at_surfaces(View<const Vec3> x, View<Vec3> v) const;
    void rub(View<Vec3> x, View<Vec3> v) const;
    void push_out(View<Vec3> x) const;
    void remember_start();

    std::vector<ContactPartner> partners_;
    Settings settings_;
    ContactDetector detector_;
    ContactEnergy energy_;
    StepStart start_;
    std::vector<Vec3> carried_;     ///< [vertices] start positions moved along with the surface nearby [m]
    std::vector<Vec3> detected_at_; ///< [vertices] where the pairs were found [m]
    std::vector<Nearest> nearest_;  ///< [vertices] last step's
    std::vector<double> altitude_;  ///< [vertices] the shortest of the triangles around, at the start [m]
    std::multimap<Key, Memory> memory_;
    bool has_cleared_ = false; ///< in this step: memory_ is the minimiser's, the pairs are new
    int active_count_ = 0;
    double min_gap_ = 0.0;
};

} // namespace toile
