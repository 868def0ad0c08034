#include "apps/toile/render/frame_range.h"

#include <charconv>

#include "core/base/error.h"

namespace toile::app {

std::vector<int> parse_frame_range(const std::string& text, int frame_count)
{
    const auto refuse = [&](const std::string& why) -> void {
        throw InvalidInput("--frames: \"" + text + "\" " + why +
                           "; write FIRST:LAST:STEP with frames from 0 to " +
                           std::to_string(frame_count - 1));
    };
    // Split at colons.
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == ':')
            parts.emplace_back();
        else
            parts.back() += c;
    if (parts.size() > 3)
        refuse("has more than three parts");

    const auto number = [&](size_t part, int otherwise) {
        if (part >= parts.size() || parts[part].empty())
            return otherwise;
        int value = 0;
        const char* end = parts[part].data() + parts[part].size();
        const auto [stop, error] = std::from_chars(parts[part].data(), end, value);
        if (error != std::errc{} || stop != end)
            refuse("holds \"" + parts[part] + "\", which is no whole number");
        return value;
    };
    const auto frame = [&](int value) { return value < 0 ? frame_count + value : value; };
    const int first = frame(number(0, 0));
    const bool is_single = parts.size() == 1 && !text.empty();
    const int last = is_single ? first : frame(number(1, frame_count - 1));
    const int step = number(2, 1);
    if (first < 0 || last >= frame_count || first > last)
        refuse("is outside of the existing frames");
    if (step < 1)
        refuse("has a step below 1");

    std::vector<int> frames;
    for (int k = first; k <= last; k += step)
        frames.push_back(k);
    return frames;
}

} // namespace toile::app
