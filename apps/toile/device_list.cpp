#include "apps/toile/device_list.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/backend/error.h"

namespace toile {

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
    std::istringstream words(list + ","); // getline leaves out an empty word at the end, but not before one
    for (std::string word; std::getline(words, word, ',');) {
        const int device = parse_device(word, list);
        if (std::count(devices.begin(), devices.end(), device) > 0)
            throw InvalidInput("--devices: " + std::to_string(device) + " is there twice in \"" + list +
                               "\"; name each GPU once");
        devices.push_back(device);
    }
    return devices;
}

void require_devices(const std::vector<int>& devices, const std::vector<CudaDevice>& there)
{
    std::string list;
    for (const CudaDevice& device : there)
        list += (list.empty() ? "" : ", ") + std::to_string(device.index) + " (" + device.name + ")";
    for (const int device : devices)
        if (std::none_of(there.begin(), there.end(),
                         [&](const CudaDevice& other) { return other.index == device; }))
            throw InvalidInput("--devices: there is no GPU " + std::to_string(device) +
                               "; this machine has " + std::to_string(there.size()) + ": " + list);
}

} // namespace toile
