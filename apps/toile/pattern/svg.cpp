#include "apps/toile/pattern/svg.h"

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
