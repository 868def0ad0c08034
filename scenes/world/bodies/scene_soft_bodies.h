#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "garment/energy/springs.h"
#include "scenes/colliders/attachment_constraint.h"
#include "scenes/colliders/core_constraint.h"
#include "scenes/surfaces/load_soft_bodies.h"
#include "volume/energy/elastic_solid.h"

namespace toile::garment {
class DeviceLoads;
} // namespace toile::garment

namespace toile::scenes {

/// The soft bodies of a running scene. Their ClothGroup moves them, among its unknowns: the vertices of all
/// surfaces follow each other, and so do those inside. Fields here are of all unknowns of the group.
class SceneSoftBodies {
public:
    /// @param first_surface   unknown of the first vertex of a surface
    /// @param between         unknowns between the surfaces and what is inside
    /// @throws InvalidInput for a mesh, material or attachment that does not work
    SceneSoftBodies(const Scene& scene, const std::vector<Collider>& colliders, int first_surface,
                    int between);

    int count() const { return int(bodies_.size()); }
    const ClothState& state(int body) const { return bodies_[body].surface; } ///< at the start

    /// Surface of a body for pictures and caches at the start; null: none.
    const ClothState* render_state(int body) const
    {
        return bodies_[body].render ? &bodies_[body].render->state : nullptr;
    }
    /// Its positions [m]. @param x  [unknowns] [m]
    std::vector<Vec3> render_positions(int body, View<const Vec3> x) const;

    int surface_count() const { return first_inner_ - between_ - bodies_.front().first_surface; }
    int inner_count() const { return unknown_count() - first_inner_; }
    int unknown_count() const { return int(rest_->corners_of_vertex.first.size()) - 1; } ///< of the group
    int first_vertex(int body) const { return bodies_[body].first_surface; }
    int body_of(int unknown) const;                             ///< of a vertex
    double mass(int body) const { return mass(bodies_[body]); } ///< [kg]
    /// [unknowns of the group] Number of a body through which sound passes within dt [s], -1: of none. Empty:
    /// there is no such body.
    std::vector<int> stiff_parts(double dt) const;
    std::vector<int> unknowns(int body) const; ///< [vertices of the body] ascending

    /// [vertices of the body] at rest, in the body's own axes [m]
    const std::vector<Vec3>& rest_positions(int body) const { return bodies_[body].rest.positions; }

    /// Tetrahedra of a body that are flat or inside out: det F <= 0.
    int inverted_count(int body, View<const Vec3> x) const;

    void set_start(View<Vec3> positions, View<Vec3> velocities, View<double> masses) const;

    /// [vertices of a surface] nonzero for those that follow a core or an exact attachment, now or later.
    std::vector<char> fixed_surface(int body) const;

    /// Moves the surface of a body at the start, whose inside follows where it is free.
    /// @param surface  [vertices of the surface] [m]
    /// @param x        [unknowns] [m]
    void place(int body, View<const Vec3> surface, View<Vec3> x);
    std::vector<std::shared_ptr<Energy>> energies() const;

    /// Appends the triangles of all surfaces.
    void append_triangles(std::vector<Triangle>& triangles) const;

    /// See SceneCloth.
    void tie(const std::vector<Collider>& colliders);
    void mark_fixed(double t_t1, View<unsigned char> fixed) const;
    void update_targets(double t_t1, const std::vector<Collider>& colliders, View<Vec3> targets);
    bool have_cores_jumped(const std::vector<Collider>& colliders, double dt) const; ///< see CoreConstraint
    void accelerate(double dt, View<const Vec3> v, View<Vec3> acceleration) const;
    void add_loads(garment::DeviceLoads& loads) const; ///< the same on a GPU
    bool is_disturbed(double t) const;

private:
    struct Body {
        int first_surface, first_inner; ///< unknowns
        double density, damping;        ///< [kg/m^3], [1/s]
        double sound_speed;             ///< [m/s] along a bar
        Vec3 velocity;                  ///< [m/s]
        ClothState surface;
        volume::TetMesh rest;        ///< [m] in its own axes
        std::vector<Vec3> positions; ///< [vertices] at the start [m]
        std::optional<RenderSurface> render;
        std::optional<CoreConstraint> core;
        std::vector<AttachmentConstraint> attachments;

        int surface_count() const { return int(surface.positions.size()); }
        int vertex_count() const { return int(positions.size()); }
        int unknown(int vertex) const
        {
            return vertex < surface_count() ? first_surface + vertex : first_inner + vertex - surface_count();
        }
        volume::Tet unknowns(const volume::Tet& tet) const
        {
            return {unknown(tet[0]), unknown(tet[1]), unknown(tet[2]), unknown(tet[3])};
        }
    };
    void add_attachments(const Scene& scene, const std::vector<Collider>& colliders, View<const int> of_file,
                         Body& body);
    template <typename IsWanted, typename Visit>
    static void visit_held(const Body& body, const IsWanted& is_wanted, const Visit& visit);
    static std::vector<char> held(const Body& body);
    static void require_one_owner(const Body& body, const std::string& core_location);
    void add_springs();
    static double mass(const Body& body);

    Vec3 gravity_;
    int between_, first_inner_;
    std::vector<Body> bodies_;
    std::shared_ptr<const volume::RestTets> rest_; ///< of all, by unknowns
    std::shared_ptr<volume::ElasticSolid> elastic_;
    std::shared_ptr<garment::Springs> springs_; ///< null without attachments by springs
};

} // namespace toile::scenes
