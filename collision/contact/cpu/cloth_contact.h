#pragma once

#include "collision/contact/cloth_contact.h"

namespace toile::collision {

/// ClothContact on the CPU.
class HostClothContact : public ClothContact {
public:
    /// See make_cloth_contact.
    HostClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                     const std::vector<ContactCloth>& cloths, View<const double> altitude);

    void begin_step(const StepStart& start) override;
    void append_pairs(std::vector<ContactPair>& out) const override;
    bool is_clear() const override { return pairs_.empty(); }
    bool advance(StepField x, const FindSupported& find_supported) override;
    bool limit_motion(StepField x, StepField v, double dt, const FindSupported& find_supported) override;
    void set_crossing(View<const unsigned char> crosses) override { exempt_.set_crossing(crosses); }
    void end_step(StepField x) override;
    void forget() override;

private:
    void search(View<const Vec3> x);
    void search_from(View<const Vec3> x, View<const Vec3> wanted, bool goes_on);
    bool has_slid(View<const Vec3> x) const;

    NearPairs near_;
    ExemptPairs exempt_;
    CollisionFreeStep free_step_;
    std::vector<double> slack_; ///< [vertices] see CollisionFreeStep [m]
    std::vector<NearPair> pairs_;
    View<const Vec3> prediction_;
    View<const unsigned char> fixed_;
    std::vector<Vec3> deviation_, motion_, expected_; ///< [vertices] [m]
};

} // namespace toile::collision
