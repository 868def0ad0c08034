#pragma once

#include <string>
#include <vector>

#include "core/backend/cuda/device.h"

namespace toile {

/// The numbers of `--devices`, e.g. "0,1", in their order.
/// @throws InvalidInput naming what is no number or is there twice
std::vector<int> parse_devices(const std::string& list);

/// @param there  the GPUs of this machine, at least one
/// @throws InvalidInput naming the first number that none of them has, and those that they have
void require_devices(const std::vector<int>& devices, const std::vector<CudaDevice>& there);

} // namespace toile
