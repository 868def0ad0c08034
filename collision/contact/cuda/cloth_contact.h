#pragma once

#include "collision/ccd/cuda/ccd_search.h"
#include "collision/ccd/trajectory_limiter.h"
#include "collision/contact/cloth_contact.h"
#include "core/compute/cuda/sum_scratch.h"

namespace toile::collision {

/// ClothContact on a GPU. Pairs, trajectories and deviations stay on the device. The host limits
/// trajectories, if needed, with a copy of the positions, and carries cloth along with bodies that move.
class DeviceClothContact : public ClothContact {
public:
    /// @param space  borrowed
    DeviceClothContact(const CudaSpace& space, ContactSoup soup);

    /// @param start  with `device`
    void begin_step(const StepStart& start, NearbyBodies& near) override;
    View<const Vec3> carried() const override;
    void end_search() override;
    void append_pairs(std::vector<ContactPair>& out) const override;
    View<const ContactPair> pressing_on_device() const override { return pressing_.view(); }
    ReplacedPairs replaced() const override;
    bool is_clear() const override { return free_step_.pairs().size() == 0; }
    bool advance(StepField x, const FindSupported& find_supported) override;
    bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) override;
    void end_step(StepField x) override;
    void abandon_step() override;
    void forget() override;

private:
    DeviceClothContact(const CudaSpace& space, ContactSoup soup, const SurfaceEdges& edges);

    void begin_bodies(const StepStart& start, NearbyBodies& near);
    View<const Vec3> with_bodies(View<const Vec3> x);
    double limit(StepField x, const FindSupported& find_supported);
    double limit_blocked(StepField x, const FindSupported& find_supported);
    double take_half_back(StepField x, bool with_fixed);
    View<const NearPair> found_pairs();
    void forget_motion();
    void copy_base();
    void begin_search();
    void search_from(View<const Vec3> x, bool was_limited, bool goes_on);
    void list_pressing();
    bool has_slid(View<const Vec3> x);
    FindPressing find_pressing() const;
    GuardOf guards() const;

    const CudaSpace& space_;
    DeviceArray<double> half_thickness_;                  ///< [vertices] [m]
    DeviceArray<double> slack_, slack_of_start_;          ///< [vertices] now; at the start of the step [m]
    View<const Vec3> prediction_;                         ///< [cloth] on the device [m]
    DeviceArray<Vec3> deviation_;                         ///< [cloth] [m]
    DeviceArray<Vec3> base_, motion_, expected_;          ///< [vertices] see HostClothContact [m]
    DeviceArray<Vec3> end_, wanted_;                      ///< [vertices] likewise [m]
    DeviceArray<Vec3> body_motion_, outward_;             ///< [bodies] see GuardOf
    DeviceArray<int> collider_;                           ///< [bodies] likewise
    DeviceArray<unsigned char> is_open_, open_colliders_; ///< [bodies], [colliders]
    AsyncNearPairs near_;
    DeviceExemptPairs exempt_;
    DeviceCollisionFreeStep free_step_;
    DeviceArray<ContactPair> pressing_;
    DeviceArray<unsigned char> marks_;             ///< [pairs] 1: presses
    DeviceArray<unsigned char> stopped_on_device_; ///< [vertices] see stopped()
    DeviceArray<int> indices_;                     ///< [pairs] of the pairs that press
    PinnedArray<int> count_;
    SumScratch<int> sum_;
    DeviceScratch scratch_;

    // On the host, for limited trajectories and for bodies.
    DeviceCcdSearch ccd_search_;
    CarriedStart carry_;
    TrajectoryLimiter limiter_;
    bool has_base_ = false;             ///< host_base_ is that of the last search
    PinnedArray<Vec3> host_base_;       ///< [vertices] [m]
    PinnedArray<Vec3> host_wanted_;     ///< [vertices] before the last limit(), halved if it has halved [m]
    PinnedArray<Vec3> host_prediction_; ///< [cloth] [m]
    std::vector<Vec3> host_end_;        ///< [vertices] of the last limit() [m]
    std::vector<Vec3>
        host_requested_; ///< [cloth] before the last limit() if it has taken half back; else empty
};

} // namespace toile::collision
