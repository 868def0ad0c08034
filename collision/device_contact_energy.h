#pragma once

#include "collision/contact_energy.h"
#include "core/backend/cuda/array.h"
#include "core/pd/device/device_active_set.h"

namespace toile {

/// ContactEnergy on a GPU, from terms that the host has made.
class DeviceContactEnergy : public DeviceActiveSet {
public:
    /// @param space  borrowed
    explicit DeviceContactEnergy(const CudaSpace& space);

    /// Takes over the terms as they now are. Grows where it has to.
    void take(const ContactEnergy& energy, int vertex_count);

    bool has_terms() const override { return terms_.size() > 0; }
    void add_gradient(View<const Vec3> x, View<Vec3> gradient, View<double> energy) override;
    bool activate(View<const Vec3> x) override;
    void multiply(View<const Vec3> p) override;
    Frozen frozen() const override;

private:
    ContactTouches touches() const { return {terms_.view(), first_.view(), entries_.view()}; }

    const CudaSpace& space_;
    DeviceArray<ContactTerm> terms_;
    DeviceArray<int> vertices_, first_, entries_; ///< ContactEnergy::Touches
    DeviceArray<int> list_of_;                    ///< [vertices] see Frozen
    DeviceArray<Vec3> force_;                     ///< [terms] [N]
    DeviceArray<double> term_energy_;             ///< [terms] [J]
    DeviceArray<FrozenContact> frozen_;           ///< [terms]
    DeviceArray<Mat3> blocks_;                    ///< [touched]
    DeviceArray<Vec3> product_;                   ///< [touched] [N]
    DeviceArray<int> acting_, acting_sums_;
    PinnedArray<int> acting_on_host_;
};

} // namespace toile
