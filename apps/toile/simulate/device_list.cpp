#include "apps/toile/simulate/device_list.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/base/error.h"
#include "core/compute/cuda/runtime/device.h"

namespace toile::app {

namespace {

constexpr const char* kRemedy = "give numbers of GPUs with commas between, e.g. 0,1";

int parse_device(const std::string& word, const std::string& list)
{
    int device = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, device);
    if (error != std::errc() || stop != end || device < 0)
        throw InvalidInput("--devices: \"" + word + "\" in \"" + list + "\" is no number of a GPU; " +
                           kRemedy);
    return device;
}

} // namespace

std::vector<int> parse_devices(const std::string& list)
{
    if (list.empty())
        throw InvalidInput(std::string("--devices: is empty; ") + kRemedy);
    std::vector<int> devices;
    std::istringstream words(list + ","); // getline drops an empty last word, but not one before a comma
    for (std::string word; std::getline(words, word, ',');) {
        const int device = parse_device(word, list);
        if (std::count(devices.begin(), devices.end(), device) > 0)
            throw InvalidInput("--devices: " + std::to_string(device) + " appears twice in \"" + list +
                               "\"; name each GPU once");
        devices.push_back(device);
    }
    return devices;
}

void require_devices(const std::vector<int>& devices, const std::vector<CudaDevice>& available)
{
    std::string list;
    for (const CudaDevice& device : available)
        list += (list.empty() ? "" : ", ") + std::to_string(device.index) + " (" + device.name + ")";
    for (const int device : devices)
        if (std::none_of(available.begin(), available.end(),
                         [&](const CudaDevice& other) { return other.index == device; }))
            throw InvalidInput("--devices: there is no GPU " + std::to_string(device) +
                               "; this machine has " + std::to_string(available.size()) + ": " + list);
}

} // namespace toile::app
