#pragma once

#include <string>
#include <vector>

namespace toile {
struct CudaDevice;
} // namespace toile

namespace toile::app {

/// GPU numbers of `--devices`, e.g. "0,1", in their order.
/// @throws InvalidInput naming a word that is no number or a number given twice
std::vector<int> parse_devices(const std::string& list);

/// @param available  the GPUs of this machine, at least one
/// @throws InvalidInput naming the first number without a GPU, and the available GPUs
void require_devices(const std::vector<int>& devices, const std::vector<CudaDevice>& available);

} // namespace toile::app
