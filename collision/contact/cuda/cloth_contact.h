#pragma once

#include "collision/ccd/cuda/collision_free_step.h"
#include "collision/ccd/trajectory_limiter.h"
#include "collision/contact/cloth_contact.h"
#include "core/compute/cuda/sum_scratch.h"

namespace toile::collision {

/// ClothContact on a GPU. Pairs, trajectories and deviations stay on the device. The host limits
/// trajectories, if needed, with a copy of the positions.
class DeviceClothContact : public ClothContact {
public:
    /// See make_cloth_contact.
    DeviceClothContact(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                       const std::vector<ContactCloth>& cloths, View<const double> altitude);

    /// @param start  with `device`
    void begin_step(const StepStart& start, NearbyBodies& bodies) override;
    void end_search() override;
    void append_pairs(std::vector<ContactPair>& out) const override;
    View<const ContactPair> pressing_on_device() const override { return pressing_.view(); }
    bool is_clear() const override { return free_step_.pairs().size() == 0; }
    bool advance(StepField x, const FindSupported& find_supported) override;
    bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) override;
    void set_crossing(View<const unsigned char> crosses) override;
    void end_step(StepField x) override;
    void forget() override;

private:
    double limit(StepField x, const FindSupported& find_supported);
    void copy_base();
    void begin_search(View<const Vec3> x);
    void search_from(View<const Vec3> x, bool was_limited, bool goes_on);
    void list_pressing();
    bool has_slid(View<const Vec3> x);
    FindPressing find_pressing() const;

    const CudaSpace& space_;
    DeviceArray<double> half_thickness_, slack_;                      ///< [vertices] [m]
    View<const Vec3> prediction_;                                     ///< [vertices] on the device [m]
    DeviceArray<Vec3> base_, deviation_, motion_, expected_, wanted_; ///< [vertices] [m]
    AsyncNearPairs near_;
    DeviceExemptPairs exempt_;
    DeviceCollisionFreeStep free_step_;
    DeviceArray<ContactPair> pressing_;
    DeviceArray<unsigned char> marks_; ///< [pairs] 1: presses
    DeviceArray<int> indices_;         ///< [pairs] of the pairs that press
    PinnedArray<int> count_;
    SumScratch<int> sum_;
    DeviceScratch scratch_;

    // On the host, for limited trajectories.
    TrajectoryLimiter limiter_;
    View<const unsigned char> fixed_;
    bool has_base_ = false;         ///< host_base_ is that of the last search
    PinnedArray<Vec3> host_base_;   ///< [vertices] [m]
    PinnedArray<Vec3> host_wanted_; ///< [vertices] x before it was limited [m]
};

} // namespace toile::collision
