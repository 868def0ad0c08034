#pragma once

#include "collision/body/collider_pairs.h"
#include "collision/contact/cpu/gauss_seidel.h"
#include "collision/contact/energy.h"
#include "collision/contact/memory.h"
#include "collision/contact/rules.h"
#include "collision/contact/terms.h"

namespace toile::collision {

/// ContactTerms on the CPU, in a ContactEnergy.
class HostContactTerms : public ContactTerms {
public:
    /// @param energy  borrowed; receives the terms
    /// Others: see Contact.
    HostContactTerms(ContactEnergy& energy, View<const Triangle> triangles, View<const Vec3> positions,
                     const std::vector<ContactCloth>& cloths, const std::vector<ContactCollider>& colliders,
                     const Settings& settings);

    View<const Vec3> advect(const StepStart& start) override { return colliders_.advect(start); }
    View<const NearestSurface> nearest() override { return colliders_.nearest(); }
    void begin_step(const StepStart& start, View<const Vec3> carried) override;
    void make(const ClothContact* between) override;
    bool empty() const override { return energy_.terms().empty(); }
    void see(StepField x) override
    {
        seen_ = x;
        x_ = x.host();
    }
    TermSums update_forces() override;
    void adopt_forces() override;
    void update_multipliers(bool is_near) override;
    void mark_touching(View<unsigned char> touches) override;
    std::vector<unsigned char> supported() override;
    bool has_left(double trust) override;
    void find_again() override;
    double deepest() override;
    bool project_compliant(int sweeps) override;
    void project_normal(double max_depth) override;
    void stop_at_surfaces(StepField v) override;
    void project_friction(StepField v) override;
    void remember(Slip slip) override;
    int remembered() const override { return memory_.size(); }
    double end_step() override;
    void abandon_step() override;
    void forget() override;

private:
    std::vector<double> clearance_of_planes(const std::vector<ContactPair>& pairs) const;
    ContactQuery query() const { return {energy_.terms(), x_}; }

    ContactEnergy& energy_;
    ContactTables tables_;
    Settings settings_;
    ColliderPairs colliders_;
    ContactRules rules_;               ///< of this step
    ProjectionRules projection_rules_; ///< likewise
    CpuGaussSeidel gauss_seidel_;
    std::vector<double> projection_force_; ///< [terms] see ProjectCompliant
    StepField seen_{View<Vec3>()};
    View<const Vec3> x_; ///< of seen_
    std::vector<unsigned char>
        out_of_bounds_;                      ///< [vertices] 1: its pairs with colliders are to be found again
    ContactMemory memory_, memory_of_start_; ///< the latter if has_remembered_
    bool has_remembered_ = false;            ///< in this step
};

} // namespace toile::collision
