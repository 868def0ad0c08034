#pragma once

// Declared here, not included: Embree's headers stay inside this folder's sources.
struct RTCDeviceTy;

namespace toile::collision {

/// The process's single Embree device, created by the first caller. Scenes keep their own reference to it.
/// @throws DeviceError if Embree cannot start on this machine, std::bad_alloc if it lacks memory.
RTCDeviceTy* embree_device();

/// Embree's calls return no error; it is asked for afterwards.
/// @throws std::bad_alloc or DeviceError if a call of this thread has failed since the last question
void require_embree_success();

} // namespace toile::collision
