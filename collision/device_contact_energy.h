#pragma once

#include "collision/acting_entries.h"
#include "collision/contact_kernels.h"
#include "core/backend/cuda/report.h"
#include "core/backend/cuda/sort.h"
#include "core/backend/turns.h"
#include "core/pd/device/device_active_set.h"

namespace toile {

/// ContactEnergy on a GPU.
class DeviceContactEnergy : public DeviceActiveSet {
public:
    /// @param space  borrowed
    explicit DeviceContactEnergy(const CudaSpace& space);

    /// The terms, for who makes them; touch() follows. Grows where it has to.
    View<ContactTerm> make_room(int count);
    /// Lists who touches what. Waits.
    void touch(int vertex_count);

    /// Those of the host.
    void set_terms(View<const ContactTerm> terms, int vertex_count);

    View<const ContactTerm> terms() const { return terms_.view(); }
    View<ContactTerm> change_terms() { return terms_.view(); }    ///< not what they touch
    View<const int> vertices() const { return vertices_.view(); } ///< [lists] see ContactEnergy::Touches
    ContactTouches touches() const { return {terms_.view(), first_.view(), entries_.view()}; }

    SharedLists lists() const { return {list_of_.view(), first_.view(), entries_.view()}; }

    bool has_terms() const override { return terms_.size() > 0; }
    void evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy) override;
    void multiply(View<const PaddedVec3> p) override;
    Frozen frozen() const override;

private:
    ActingEntries acting_there();

    const CudaSpace& space_;
    int room_ = 0; ///< terms
    DeviceArray<ContactTerm> terms_;
    DeviceArray<int> vertices_, first_, entries_; ///< ContactEnergy::Touches
    DeviceArray<int> list_of_;                    ///< [vertices] see Frozen
    DeviceArray<Vec3> force_;                     ///< [terms] [N]
    DeviceArray<double> term_energy_;             ///< [terms] [J]
    DeviceArray<FrozenContact> frozen_;           ///< [terms]
    DeviceArray<Mat3> blocks_;                    ///< [touched]
    DeviceArray<Vec3> product_;                   ///< [touched] [N]
    DeviceArray<int> acting_count_;               ///< [touched] see ActingEntries
    DeviceArray<ActingEntry> acting_entries_;     ///< [4 x terms] likewise
    SortArrays sort_;                             ///< [4 x terms] by vertex
    DeviceArray<unsigned char> flags_;            ///< [4 x terms + 1]
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile
