#pragma once

#include "collision/contact_memory.h"
#include "collision/device_contact_kernels.h"
#include "core/backend/cuda/sort.h"

namespace toile {

/// ContactMemory on a GPU: records sorted by a hash of their keys, those of a key in the order of their
/// terms.
class DeviceContactMemory {
public:
    explicit DeviceContactMemory(const CudaSpace& space); ///< borrowed

    void forget() { records_.resize(0); }
    int size() const { return records_.size(); }

    /// Forgets all and keeps the terms that press. Waits.
    /// @param x  [vertices] that the slip is of [m]; all of the device
    void keep(View<const ContactTerm> terms, const ContactRules& rules, RememberedSlip slip,
              View<const Vec3> x);

    KnownContacts known() const { return {hashes_.sorted_keys.view(), order_.view(), records_.view()}; }

private:
    const CudaSpace& space_;
    DeviceArray<ContactRecord> records_;
    SortArrays hashes_;      ///< [records]
    DeviceArray<int> order_; ///< [records] by hash
    DeviceArray<unsigned char> flags_;
    DeviceArray<int> pressing_;
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile
