#pragma once

#include <string>

#include "core/base/stages.h"
#include "core/compute/cuda/array.h"
#include "core/compute/cuda/readback.h"

namespace toile {

/// Array that host and device both use. It is copied when the other side asks for it, and only if it has
/// changed since. Work that moves from one side to the other thus moves its copies too. A copy to the host is
/// a call of stage "cuda/to_host".
template <typename T>
class MirroredArray {
public:
    /// Leaves the contents undefined on both sides.
    MirroredArray(const CudaSpace& space, const std::string& name, int size)
        : space_(&space), on_host_(space, name, size), on_device_(space, name, size)
    {
    }

    int size() const { return on_device_.size(); }

    /// True if the host's copy is current: host() then copies nothing.
    bool is_on_host() const { return newer_ != Newer::Device; }

    /// View on the host; waits for the device if that is newer. Valid until the device changes the array.
    View<const T> host() const
    {
        fetch();
        return on_host_.view();
    }
    /// View on the host to change all or some items.
    View<T> change_on_host()
    {
        fetch();
        return overwrite_on_host();
    }
    /// View on the host to overwrite all items; copies nothing.
    View<T> overwrite_on_host()
    {
        if (is_sending_)
            space_->synchronise();
        is_sending_ = false;
        newer_ = Newer::Host;
        return on_host_.view();
    }

    /// Begins to copy the current contents to the host and returns; later changes do not affect the copy.
    void read_back(Readback<T>& readback) const
    {
        send();
        readback.begin(on_device_);
    }

    /// View on the device, in stream order.
    View<const T> device() const
    {
        send();
        return on_device_.view();
    }
    View<T> change_on_device()
    {
        send();
        return overwrite_on_device();
    }
    View<T> overwrite_on_device()
    {
        newer_ = Newer::Device;
        return on_device_.view();
    }

private:
    enum class Newer { None, Host, Device };

    void fetch() const
    {
        if (newer_ != Newer::Device)
            return;
        const StageScope stage("cuda/to_host");
        on_device_.download(on_host_.view());
        space_->synchronise();
        newer_ = Newer::None;
    }
    void send() const
    {
        if (newer_ != Newer::Host)
            return;
        on_device_.upload(on_host_.view());
        is_sending_ = true;
        newer_ = Newer::None;
    }

    const CudaSpace* space_;
    mutable PinnedArray<T> on_host_;
    mutable DeviceArray<T> on_device_;
    mutable Newer newer_ = Newer::Device;
    mutable bool is_sending_ = false; ///< on_host_ may still be read
};

} // namespace toile
