#pragma once

#include "collision/body/cuda/collider_pairs.h"
#include "collision/contact/cuda/energy.h"
#include "collision/contact/cuda/gauss_seidel.h"
#include "collision/contact/cuda/memory.h"
#include "collision/contact/cuda/update_kernels.h"
#include "collision/contact/terms.h"
#include "core/compute/cuda/grown_array.h"

namespace toile::collision {

/// ContactTerms on a GPU: only numbers and flags of vertices are copied to the host. Every function waits for
/// its result.
class DeviceContactTerms : public ContactTerms {
public:
    /// @param space  borrowed
    /// Others: see Contact.
    DeviceContactTerms(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                       const std::vector<ContactCloth>& cloths, const std::vector<ContactCollider>& colliders,
                       const Settings& settings);

    View<const Vec3> advect(const StepStart& start) override;
    View<const NearestSurface> nearest() override;
    void begin_step(const StepStart& start, View<const Vec3> carried) override;
    void make(const ClothContact* between) override;
    bool empty() const override { return !energy_.has_terms(); }
    void see(StepField x) override { x_ = x; }
    TermSums update_forces() override;
    void adopt_forces() override;
    void update_multipliers(bool is_near) override;
    void mark_touching(View<unsigned char> touches) override;
    std::vector<unsigned char> supported() override;
    bool has_left(double trust) override;
    void find_again() override { colliders_.find_again(x_.device()); }
    double deepest() override;
    bool project_compliant(int sweeps) override;
    void project_normal(double max_depth) override;
    void stop_at_surfaces(StepField v) override;
    void project_friction(StepField v) override;
    void remember(Slip slip) override;
    int remembered() const override { return memory_->size(); }
    double end_step() override;
    void abandon_step() override;
    void forget() override;
    DeviceActiveSet* on_device(const CudaSpace& space) override;

    const DeviceContactEnergy& energy() const { return energy_; }

private:
    void mark_flagged(View<unsigned char> marks);
    View<unsigned char> flags() { return first_items(flags_, energy_.terms().size()); }
    ContactQuery query() const { return {energy_.terms(), x_.device()}; }

    const CudaSpace& space_;
    ContactTables tables_;
    Settings settings_;
    DeviceColliderPairs colliders_;
    DeviceContactEnergy energy_;
    std::unique_ptr<DeviceContactMemory> memory_, memory_of_start_; ///< the latter if has_remembered_
    bool has_remembered_ = false;                                   ///< in this step
    ContactRules rules_;                                            ///< of this step
    ProjectionRules projection_rules_;                              ///< likewise
    StepField x_{View<Vec3>()};

    DeviceArray<int> cloth_of_; ///< see ContactTables
    DeviceArray<double> gap_, collider_friction_, cloth_friction_;
    DeviceArray<double> half_thickness_; ///< [vertices]
    DeviceArray<int> rigid_;             ///< see ProjectionRules
    DeviceArray<double> altitude_;

    DeviceArray<double> clearance_, overlap_; ///< see FindOpposingClearance
    DeviceArray<unsigned char> pair_flags_;   ///< [pairs]
    DeviceArray<unsigned char> flags_;        ///< [terms]
    DeviceArray<unsigned char> supported_;    ///< [vertices]
    DeviceArray<int> list_;                   ///< indices of flagged items
    DeviceGaussSeidel gauss_seidel_;
    DeviceArray<double> projection_force_; ///< [terms] see ProjectCompliant
    PinnedArray<Vec3> advected_;           ///< see advect()
    PinnedArray<NearestSurface> nearest_;  ///< see nearest()
    PinnedArray<int> count_;
    SumScratch<TermSums> limits_;
    SumScratch<Smallest> smallest_;
    DeviceScratch scratch_;
};

} // namespace toile::collision
