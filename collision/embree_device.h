#pragma once

// Declared here, not included: Embree's headers stay inside this folder's sources.
struct RTCDeviceTy;

namespace toile {

/// The process's one Embree device, created by the first caller. Scenes keep their own reference to it.
/// @throws DeviceError when Embree can't start on this machine.
RTCDeviceTy* embree_device();

} // namespace toile
