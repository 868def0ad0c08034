#pragma once

#include <array>
#include <utility>
#include <vector>

#include "collision/ccd/carried_start.h"
#include "collision/contact/cloth_contact_rules.h"
#include "collision/contact/contact_cloth.h"
#include "collision/contact/let_through.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile::collision {

/// Cloths and bodies that are kept from crossing, as one list of triangles: first those of all cloths, then
/// those of bodies; vertices likewise.
struct ContactSoup {
    /// See make_cloth_contact.
    ContactSoup(View<const Triangle> cloth_triangles, View<const Vec3> cloth_positions,
                const std::vector<ContactCloth>& cloths, View<const double> cloth_altitude,
                BodySurfaces bodies, bool cloth_with_cloth);

    bool has_bodies() const { return !bodies.is_empty(); }
    int vertex_count() const { return int(positions.size()); }
    View<const Triangle> triangles_of_cloth() const
    {
        return View<const Triangle>(triangles).subview(0, int(triangles.size() - bodies.triangles().size()));
    }
    /// Those of cloth or of bodies among values of all vertices.
    template <typename T>
    View<T> of_cloth(View<T> all) const
    {
        return all.subview(0, first_body);
    }
    template <typename T>
    View<T> of_bodies(View<T> all) const
    {
        return all.subview(first_body, all.size() - first_body);
    }

    std::vector<ContactCloth> cloths;
    BodySurfaces bodies;
    int first_body; ///< first vertex of bodies, number of vertices of cloth
    std::vector<Triangle> triangles;
    std::vector<Vec3> positions;  ///< [vertices] of cloth at the start, of bodies at t1 [m]
    std::vector<double> altitude; ///< [vertices] see shortest_altitudes [m]; infinite for bodies
    std::vector<int> rigid;       ///< [vertices] see NearPairs
};

/// Surfaces near each vertex of cloth, for the host.
class NearbyBodies {
public:
    virtual ~NearbyBodies() = default;
    /// [vertices] positions at t0 advected with the nearest surfaces [m]
    virtual View<const Vec3> advect(const StepStart& start) = 0;
    virtual View<const NearestSurface> nearest() = 0; ///< [vertices] of the last step
};

/// Bodies of a ClothContact, on the host for CPU and GPU alike: cloth goes along with those that move, and
/// lets those through that leave it no room.
class ContactBodies {
public:
    /// All are borrowed.
    /// @param exempt  receives the pairs with bodies that are exempt
    ContactBodies(ContactSoup& soup, const ClothContactRules& rules, ExemptPairs& exempt);

    const BodySurfaces& surfaces() const { return soup_.bodies; }

    /// See BodySurfaces.
    bool find_jumps(double dt) { return soup_.bodies.find_jumps(dt); }

    /// False if begin_step() would change nothing: bodies stand, and cloth keeps off all of them.
    bool needs_begin() const;

    /// Begins a step.
    /// @param start   fields of the host, and of the device if a GPU makes the step
    /// @param carry   with pairs of the soup
    /// @param fixed   [vertices of the soup] 1: attached cloth, and bodies
    /// @param base    [vertices of the soup] in: cloth at t0; out: start of the trajectories [m]
    void begin_step(const StepStart& start, NearbyBodies& near, CarriedStart& carry,
                    View<const unsigned char> fixed, View<Vec3> base);

    bool have_carried() const { return has_carried_; } ///< cloth along with them, in this step

    /// Guards of this step, with fields of the host.
    /// @param base  [vertices of the soup] [m]
    GuardOf guards(View<const Vec3> base) const
    {
        return {soup_.first_body, base, motion_, collider_, is_open_, outward_};
    }

    /// See ExemptPairs. @param crossings  vertices of cloth and of surfaces(), of triangles that cross
    /// @param inside  [vertices of cloth] 1: inside a body; empty: none is
    void set_crossings(View<const BodyCrossing> crossings, View<const unsigned char> inside);

    /// Number of pairs in this step that bodies have closed on and that cross from now on.
    int stuck_count() const { return int(stuck_.size()); }
    int first_stuck() const; ///< a vertex of cloth of the first of them

    const LetThrough& let_through() const { return let_through_; }
    /// See LetThrough::close. @param crossing  triangles of cloth that cross surfaces() at t0
    void close_let_through(View<const int> crossing);

    /// Discards the state of earlier steps.
    void forget();

private:
    void stand(View<Vec3> base);
    void move(const StepStart& start, View<const NearestSurface> nearest, View<const Vec3> advected,
              CarriedStart& carry, View<const unsigned char> fixed, View<Vec3> base);
    void fade(View<const NearestSurface> nearest, View<const unsigned char> fixed, View<Vec3> way) const;
    void exempt_stuck();
    void show_let_through();
    bool release(View<const BlockedPair> blocked, bool is_last);

    ContactSoup& soup_;
    const ClothContactRules& rules_;
    ExemptPairs& exempt_;
    LetThrough let_through_;
    std::vector<int> collider_;
    std::vector<unsigned char> is_open_;
    std::vector<Vec3> motion_;
    View<const Vec3> outward_; ///< of let_through_, if a surface is open
    bool has_open_;
    std::vector<CarriedStart::StuckPair> stuck_;
    bool has_begun_ = false, has_carried_ = false;
};

} // namespace toile::collision
