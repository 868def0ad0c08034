#pragma once

#include "collision/collider_pairs.h"
#include "collision/contact_energy.h"
#include "collision/contact_memory.h"
#include "collision/contact_rules.h"
#include "collision/contact_terms.h"
#include "collision/host_turns.h"

namespace toile {

/// ContactTerms on the CPU: those of a ContactEnergy.
class HostContactTerms : public ContactTerms {
public:
    /// @param energy  borrowed: gets the terms
    /// Others as Contact's.
    HostContactTerms(ContactEnergy& energy, View<const Triangle> triangles, View<const Vec3> positions,
                     const std::vector<ContactCloth>& cloths, const std::vector<ContactPartner>& partners,
                     const Settings& settings);

    void begin_step(const StepStart& start) override;
    void make(const ClothContact* between) override;
    bool empty() const override { return energy_.terms().empty(); }
    void see(StepField x) override
    {
        seen_ = x;
        x_ = x.host();
    }
    FrictionLimits look_at_forces() override;
    void adopt_forces() override;
    std::vector<unsigned char> leaning() override;
    bool has_left(double trust) override;
    void find_again() override;
    double deepest() override;
    bool push_to_rest(int sweeps) override;
    void push_out(double most) override;
    void stop_at_surfaces(StepField v) override;
    void rub(StepField v) override;
    void remember(Slip slip) override;
    int remembered() const override { return memory_.size(); }
    double end_step() override;
    void forget() override;

private:
    std::vector<double> room_of(const std::vector<ContactPair>& pairs) const;
    ContactLook look() const { return {energy_.terms(), x_}; }

    ContactEnergy& energy_;
    ContactTables tables_;
    Settings settings_;
    ColliderPairs colliders_;
    ContactRules rules_;   ///< of this step
    PushRules push_rules_; ///< likewise
    HostTurns turns_;
    std::vector<double> push_force_; ///< [terms] see PushToRest
    StepField seen_{View<Vec3>()};
    View<const Vec3> x_;                ///< of seen_
    std::vector<unsigned char> strays_; ///< [vertices] 1 where pairs with colliders are to be found again
    ContactMemory memory_;
};

} // namespace toile
