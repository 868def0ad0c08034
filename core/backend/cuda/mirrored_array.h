#pragma once

#include <string>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/readback.h"
#include "core/backend/stages.h"

namespace toile {

/// An array that host and device both work on. It is copied when the other side asks for it and only where it
/// has changed since, so work that moves from one side to the other takes its copies with it. A copy to the
/// host is a call of stage "cuda/to_host".
template <typename T>
class MirroredArray {
public:
    /// Undefined at first, of both sides.
    MirroredArray(const CudaSpace& space, const std::string& name, int size)
        : space_(&space), on_host_(space, name, size), there_(space, name, size)
    {
    }

    int size() const { return there_.size(); }

    /// True where the host has it as it is: nothing is copied when it asks.
    bool is_on_host() const { return newer_ != Newer::Device; }

    /// On the host; waits for the device where that is newer. Good until the device changes it.
    View<const T> host() const
    {
        fetch();
        return on_host_.view();
    }
    /// The same to change all or some of it.
    View<T> change_on_host()
    {
        fetch();
        return overwrite_on_host();
    }
    /// The same to change all of it, whatever it was.
    View<T> overwrite_on_host()
    {
        if (is_sending_)
            space_->synchronise();
        is_sending_ = false;
        newer_ = Newer::Host;
        return on_host_.view();
    }

    /// Begins to bring it to the host as it is now, whatever becomes of it, and does not wait.
    void read_back(Readback<T>& readback) const
    {
        send();
        readback.begin(there_);
    }

    /// On the device, in the stream's turn.
    View<const T> there() const
    {
        send();
        return there_.view();
    }
    View<T> change_there()
    {
        send();
        return overwrite_there();
    }
    View<T> overwrite_there()
    {
        newer_ = Newer::Device;
        return there_.view();
    }

private:
    enum class Newer { None, Host, Device };

    void fetch() const
    {
        if (newer_ != Newer::Device)
            return;
        const StageScope stage("cuda/to_host");
        there_.download(on_host_.view());
        space_->synchronise();
        newer_ = Newer::None;
    }
    void send() const
    {
        if (newer_ != Newer::Host)
            return;
        there_.upload(on_host_.view());
        is_sending_ = true;
        newer_ = Newer::None;
    }

    const CudaSpace* space_;
    mutable PinnedArray<T> on_host_;
    mutable DeviceArray<T> there_;
    mutable Newer newer_ = Newer::Device;
    mutable bool is_sending_ = false; ///< on_host_ may still be read
};

} // namespace toile
