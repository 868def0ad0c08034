#pragma once

namespace toile {

/// Whether a GPU still takes work from this process. It does not once a kernel or the device itself has
/// failed. Does not wait for the work of streams, but shows a failure of it.
/// @param device  its number
bool is_responding(int device);

} // namespace toile
