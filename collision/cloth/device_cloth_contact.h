#pragma once

#include "collision/cloth/bring_back.h"
#include "collision/cloth/cloth_contact.h"
#include "collision/cloth/device_safe_step.h"
#include "core/backend/cuda/sum_scratch.h"

namespace toile {

/// ClothContact on a GPU. Pairs, ways and what is learnt of them stay there; where something is to be brought
/// back the host does that with a copy of the positions.
class DeviceClothContact : public ClothContact {
public:
    /// See make_cloth_contact.
    DeviceClothContact(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                       const std::vector<ContactCloth>& cloths, View<const double> altitude);

    /// @param start  with `there`
    void begin_step(const StepStart& start) override;
    void end_search() override;
    void append_pairs(std::vector<ContactPair>& out) const override;
    View<const ContactPair> pressing_there() const override { return pressing_.view(); }
    bool advance(StepField x, const Leaning& leans) override;
    bool hold_back(StepField x, StepField v, double dt, const Leaning& leans) override;
    void set_crossing(View<const unsigned char> crosses) override;
    void end_step(StepField x) override;
    void forget() override;

private:
    double limit(StepField x, const Leaning& leans);
    void copy_base();
    void begin_search(View<const Vec3> x);
    void look_on(View<const Vec3> x, bool was_held, bool goes_on);
    void list_pressing();
    bool has_slid(View<const Vec3> x);
    FindPressing find_pressing() const;

    const CudaSpace& space_;
    DeviceArray<double> half_thickness_, slack_;                      ///< [vertices] [m]
    View<const Vec3> prediction_;                                     ///< [vertices] on the device [m]
    DeviceArray<Vec3> base_, deviation_, motion_, expected_, wanted_; ///< [vertices] [m]
    AsyncNearPairs near_;
    DeviceExemptPairs exempt_;
    DeviceSafeStep safe_;
    DeviceArray<ContactPair> pressing_;
    DeviceArray<unsigned char> marks_; ///< [pairs] 1: presses
    DeviceArray<int> places_;          ///< [pairs] of those that press
    PinnedArray<int> count_;
    SumScratch<int> sum_;
    DeviceScratch scratch_;

    // Of the host, where something is brought back.
    BringBack bring_back_;
    View<const unsigned char> fixed_;
    bool has_base_ = false;         ///< host_base_ is that of the last look
    PinnedArray<Vec3> host_base_;   ///< [vertices] [m]
    PinnedArray<Vec3> host_wanted_; ///< [vertices] where x wanted to go before it was brought back [m]
};

} // namespace toile
