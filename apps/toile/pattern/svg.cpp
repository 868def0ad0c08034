#include "apps/toile/pattern/svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace toile::app::svg {

std::string number(double value)
{
    std::array<char, 32> text{};
    const double rounded = std::round(value * 100.0) / 100.0;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), rounded == 0.0 ? 0.0 : rounded);
    return {text.data(), end.ptr};
}

std::string point(const Vec2& p) { return number(p.x()) + "," + number(p.y()); }

std::string colour(double hue_deg, double saturation, double lightness)
{
    std::string text = "#";
    for (const double offset : {0.0, 8.0, 4.0}) {
        const double k = std::fmod(offset + hue_deg / 30.0, 12.0);
        const double share = std::max(-1.0, std::min({k - 3.0, 9.0 - k, 1.0}));
        const double value = lightness - saturation * std::min(lightness, 1.0 - lightness) * share;
        const auto byte = int(std::lround(255.0 * value));
        for (const int digit : {byte / 16, byte % 16})
            text += "0123456789abcdef"[digit];
    }
    return text;
}

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out;
}

std::string text(const Vec2& at, const std::string& content, const TextStyle& style)
{
    // The baseline lies about a third of the size below the middle of capitals and digits.
    std::string out = "<text x=\"" + number(at.x()) + "\" y=\"" + number(at.y()) + "\" dy=\"0.35em\"";
    out += " font-size=\"" + number(style.size) + "\" fill=\"" + style.fill + "\" text-anchor=\"";
    out += style.anchor;
    out += "\"";
    if (style.bold)
        out += " font-weight=\"bold\"";
    if (style.italic)
        out += " font-style=\"italic\"";
    if (style.rotate_deg != 0.0)
        out += " transform=\"rotate(" + number(style.rotate_deg) + " " + number(at.x()) + " " +
               number(at.y()) + ")\"";
    return out + ">" + escaped(content) + "</text>\n";
}

std::string line(const Vec2& from, const Vec2& to, const std::string& stroke, double width)
{
    return path("M" + point(from) + " L" + point(to),
                "fill=\"none\" stroke=\"" + stroke + "\" stroke-width=\"" + number(width) + "\"");
}

std::string path(const std::string& d, const std::string& attributes)
{
    return "<path d=\"" + d + "\" " + attributes + "/>\n";
}

} // namespace toile::app::svg
