#pragma once

#include <string>

#include "core/compute/types.h"

/// Elements of an SVG picture, as text. Positions in its units, y down.
namespace toile::app::svg {

/// Number with two decimals at most, whatever the locale: 12.5.
std::string number(double value);

/// "12.5,3"
std::string point(const Vec2& p);

/// "#rrggbb" of a hue in degrees, a saturation and a lightness.
std::string colour(double hue_deg, double saturation, double lightness);

/// Text with characters that have a meaning in XML replaced.
std::string escaped(const std::string& text);

struct TextStyle {
    double size = 10.0;
    std::string fill = "#333";
    const char* anchor = "middle"; ///< start, middle, end
    bool bold = false;
    bool italic = false;
    double rotate_deg = 0.0; ///< clockwise about its position
};

/// Text whose middle line goes through `at`.
std::string text(const Vec2& at, const std::string& content, const TextStyle& style);

std::string line(const Vec2& from, const Vec2& to, const std::string& stroke, double width);

/// @param d  path data
std::string path(const std::string& d, const std::string& attributes);

} // namespace toile::app::svg
