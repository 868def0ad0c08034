#include "apps/toile/render/number_list.h"

#include <charconv>
#include <cmath>

namespace toile::app {

std::optional<std::vector<double>> numbers_of(const std::string& text, size_t count)
{
    std::vector<double> numbers;
    const char *at = text.data(), *const end = at + text.size();
    while (true) {
        double number = 0.0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || !std::isfinite(number))
            return std::nullopt;
        numbers.push_back(number);
        if (stop == end)
            break;
        if (*stop != ',')
            return std::nullopt;
        at = stop + 1;
    }
    return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}

} // namespace toile::app
