#pragma once

#include "collision/ccd/cpu/ccd_search.h"
#include "collision/contact/cloth_contact.h"

namespace toile::collision {

/// ClothContact on the CPU.
class HostClothContact : public ClothContact {
public:
    explicit HostClothContact(ContactSoup soup);

    void begin_step(const StepStart& start, NearbyBodies& near) override;
    View<const Vec3> carried() const override;
    void append_pairs(std::vector<ContactPair>& out) const override;
    ReplacedPairs replaced() const override;
    bool is_clear() const override { return pairs_.empty(); }
    bool advance(StepField x, const FindSupported& find_supported) override;
    bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) override;
    void end_step(StepField x) override;
    void abandon_step() override { slack_ = slack_of_start_; }
    void forget() override;

private:
    double limit(View<Vec3> x, const FindSupported& find_supported);
    void search();
    void search_from_end(bool goes_on);
    bool has_slid() const;

    std::vector<double> slack_;          ///< [vertices] see CollisionFreeStep [m]
    std::vector<double> slack_of_start_; ///< [vertices] at the start of the step [m]
    NearPairs near_;
    CollisionFreeStep free_step_;
    CpuCcdSearch ccd_search_;
    CarriedStart carry_;
    std::vector<NearPair> pairs_;
    View<const Vec3> prediction_; ///< [cloth] [m]
    std::vector<Vec3> deviation_; ///< [cloth] [m]
    std::vector<Vec3> base_, motion_,
        expected_;                   ///< [vertices] start, displacement and end of trajectories [m]
    std::vector<Vec3> end_, wanted_; ///< [vertices] of the last limit(), and before it [m]
};

} // namespace toile::collision
