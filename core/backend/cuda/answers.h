#pragma once

namespace toile {

/// Whether a GPU still takes work from this process: not once a kernel has failed there, or the device itself
/// has. Waits for nothing that streams have been given, but what has failed there shows.
/// @param device  its number
bool answers(int device);

} // namespace toile
