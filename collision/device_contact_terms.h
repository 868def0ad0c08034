#pragma once

#include "collision/contact_terms.h"
#include "collision/device_collider_pairs.h"
#include "collision/device_contact_energy.h"
#include "collision/device_contact_memory.h"
#include "collision/device_look_kernels.h"
#include "collision/device_turns.h"
#include "core/backend/cuda/roomy.h"

namespace toile {

/// ContactTerms on a GPU: only numbers and flags of vertices come to the host. Every function waits for what
/// it returns.
class DeviceContactTerms : public ContactTerms {
public:
    /// @param space  borrowed
    /// Others as Contact's.
    DeviceContactTerms(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                       const std::vector<ContactCloth>& cloths, const std::vector<ContactPartner>& partners,
                       const Settings& settings);

    void begin_step(const StepStart& start) override;
    void make(const ClothContact* between) override;
    bool empty() const override { return !energy_.has_terms(); }
    void see(StepField x) override { x_ = x; }
    FrictionLimits look_at_forces() override;
    void adopt_forces() override;
    std::vector<unsigned char> leaning() override;
    bool has_left(double trust) override;
    void find_again() override { colliders_.find_again(x_.there()); }
    double deepest() override;
    bool push_to_rest(int sweeps) override;
    void push_out(double most) override;
    void stop_at_surfaces(StepField v) override;
    void rub(StepField v) override;
    void remember(Slip slip) override;
    int remembered() const override { return memory_.size(); }
    double end_step() override;
    void forget() override;
    DeviceActiveSet* on_device(const CudaSpace& space) override;

    const DeviceContactEnergy& energy() const { return energy_; }

private:
    void mark_flagged(View<unsigned char> marks);
    View<unsigned char> flags() { return first_items(flags_, energy_.terms().size()); }
    ContactLook look() const { return {energy_.terms(), x_.there()}; }

    const CudaSpace& space_;
    ContactTables tables_;
    Settings settings_;
    DeviceColliderPairs colliders_;
    DeviceContactEnergy energy_;
    DeviceContactMemory memory_;
    ContactRules rules_;   ///< of this step
    PushRules push_rules_; ///< likewise
    StepField x_{View<Vec3>()};

    DeviceArray<int> cloth_of_; ///< see ContactTables
    DeviceArray<double> gap_, partner_friction_, cloth_friction_;
    DeviceArray<double> half_thickness_; ///< [vertices]
    DeviceArray<int> rigid_;             ///< see PushRules
    DeviceArray<double> altitude_;

    DeviceArray<double> room_, overlap_;    ///< see FindRoom
    DeviceArray<unsigned char> pair_flags_; ///< [pairs]
    DeviceArray<unsigned char> flags_;      ///< [terms]
    DeviceArray<unsigned char> leans_;      ///< [vertices]
    DeviceArray<int> list_;                 ///< of what is flagged
    DeviceTurns turns_;
    DeviceArray<double> push_force_; ///< [terms] see PushToRest
    PinnedArray<int> count_;
    SumScratch<FrictionLimits> limits_;
    SumScratch<Least> least_;
    DeviceScratch scratch_;
};

} // namespace toile
