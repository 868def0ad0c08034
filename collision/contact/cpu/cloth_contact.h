#pragma once

#include "collision/ccd/carried_start.h"
#include "collision/contact/cloth_contact.h"
#include "collision/contact/cpu/let_through.h"

namespace toile::collision {

/// ClothContact on the CPU.
class HostClothContact : public ClothContact {
public:
    /// See make_cloth_contact.
    HostClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                     const std::vector<ContactCloth>& cloths, View<const double> altitude,
                     BodySurfaces bodies, bool cloth_with_cloth);

    void begin_step(const StepStart& start, NearbyBodies& bodies) override;
    View<const Vec3> carried() const override { return is_carried_ ? cloth_of(base_) : View<const Vec3>(); }
    int stuck_count() const override { return int(carry_.stuck().size()); }
    int first_stuck() const override;
    int let_through_count() const override { return let_through_.count(); }
    int first_let_through() const override { return let_through_.first(); }
    bool replaces(const ContactPair& pair) const override;
    void close_let_through(View<const int> crossing) override { let_through_.close(crossing); }
    bool lets_through(const Triangle& t) const override { return let_through_.is_released(t); }
    bool have_bodies_jumped(double dt) override { return bodies_.find_jumps(dt); }
    const BodySurfaces* bodies() const override { return bodies_.is_empty() ? nullptr : &bodies_; }
    void append_pairs(std::vector<ContactPair>& out) const override;
    bool is_clear() const override { return pairs_.empty(); }
    bool advance(StepField x, const FindSupported& find_supported) override;
    bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) override;
    void set_crossing(View<const unsigned char> crosses) override;
    void set_body_crossings(View<const std::pair<int, int>> crossings,
                            View<const unsigned char> inside) override;
    bool lets_through(int vertex) const override { return let_through_.is_released(vertex); }
    void end_step(StepField x) override;
    void forget() override;

private:
    /// Cloth and bodies as one list of triangles.
    struct Soup {
        Soup(View<const Triangle> triangles, View<const Vec3> positions,
             const std::vector<ContactCloth>& cloths, const BodySurfaces& bodies, bool cloth_with_cloth);

        std::vector<Triangle> triangles;
        std::vector<Vec3> positions; ///< [vertices] of cloth, then of bodies [m]
        std::vector<int> rigid;      ///< [vertices] see NearPairs
    };
    HostClothContact(const Soup& soup, View<const Triangle> triangles, View<const Vec3> positions,
                     const std::vector<ContactCloth>& cloths, View<const double> altitude,
                     BodySurfaces&& bodies);

    template <typename T>
    View<T> cloth_of(View<T> all) const
    {
        return all.subview(0, count_);
    }
    View<const Vec3> cloth_of(const std::vector<Vec3>& all) const { return cloth_of(View<const Vec3>(all)); }
    View<Vec3> bodies_of(std::vector<Vec3>& all) const
    {
        return View<Vec3>(all).subview(count_, int(all.size()) - count_);
    }
    void stand();
    void carry(View<const Vec3> advected);
    void show_let_through();
    bool release(View<const BlockedPair> blocked);
    ContactPair guard_of(const ContactPair& pair, const NearPair& near) const;
    double limit(View<Vec3> x, const FindSupported& find_supported);
    void search();
    void search_from_end(bool goes_on);
    bool has_slid() const;

    bool is_carried_ = false; ///< in this step
    int count_;               ///< vertices of cloth; all others are of bodies
    BodySurfaces bodies_;
    LetThrough let_through_;
    NearPairs near_;
    ExemptPairs exempt_;
    CollisionFreeStep free_step_;
    CarriedStart carry_;
    std::vector<double> slack_;        ///< [vertices] see CollisionFreeStep [m]
    std::vector<unsigned char> fixed_; ///< [vertices] likewise
    std::vector<NearPair> pairs_;      ///< of cloth with cloth, then with bodies
    int between_cloths_ = 0;           ///< the first of them
    View<const Vec3> prediction_;      ///< [cloth] [m]
    std::vector<Vec3> deviation_;      ///< [cloth] [m]
    std::vector<Vec3> body_motion_;    ///< [bodies] displacement in the step [m]
    std::vector<Vec3> base_, motion_,
        expected_;                   ///< [vertices] start, displacement and end of trajectories [m]
    std::vector<Vec3> end_, wanted_; ///< [vertices] of the last limit(), and before it [m]
};

} // namespace toile::collision
