#pragma once

#include "collision/contact/cuda/contact_kernels.h"
#include "collision/contact/memory.h"
#include "core/compute/cuda/sort.h"

namespace toile::collision {

/// ContactMemory on a GPU: records sorted by a hash of their keys, records of equal hash in the order of
/// their terms.
class DeviceContactMemory {
public:
    explicit DeviceContactMemory(const CudaSpace& space); ///< borrowed

    void forget() { records_.resize(0); }
    int size() const { return records_.size(); }

    /// Replaces all records by those of the terms that press. Waits.
    /// @param x  [vertices] positions of the slip [m]; all arrays on the device
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

} // namespace toile::collision
