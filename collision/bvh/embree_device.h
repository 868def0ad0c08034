#pragma once

// Declared here, not included: Embree's headers stay inside this folder's sources.
struct RTCDeviceTy;

namespace toile::collision {

/// The process's single Embree device, created by the first caller. Scenes keep their own reference to it.
/// @throws DeviceError if Embree cannot start on this machine.
RTCDeviceTy* embree_device();

} // namespace toile::collision
