#include "apps/toile/pattern/drawing.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "apps/toile/pattern/layout.h"
#include "apps/toile/pattern/svg.h"
#include "core/base/number.h"
#include "garment/pattern/edge_curve.h"

namespace toile::app {

using garment::EdgeCurve;
using garment::EdgePart;
using garment::Panel;

namespace {

// Millimetres on the sheet.
constexpr double kMargin = 34.0;      // about panels
constexpr double kHeader = 58.0;      // above them
constexpr double kFooterLine = 16.0;  // of a twisted seam
constexpr double kSeamWidth = 6.0;    // stroke of a sewn edge
constexpr double kBadgeRadius = 7.5;  // of a seam's number
constexpr double kBadgeInset = 12.0;  // of it from its edge
constexpr double kShort = 20.0;       // length of a sewn edge whose number would lie on its neighbours
constexpr double kShortInset = 26.0;  // of that number
constexpr double kLabelOffset = 8.0;  // of an edge's index from its edge
constexpr double kArrow = 6.5;        // of a seam's direction
constexpr double kRatioRoom = 70.0;   // length of a sewn edge that has room for its gather
constexpr double kButtonRadius = 4.0; // of a closure's end
constexpr double kStrip = 45.0;       // radius of the largest circle in a strip

/// Gathers from this ratio on are written at the longer side.
constexpr double kShownRatio = 1.05;

/// Width of a letter over its height, in the mean.
constexpr double kLetter = 0.6;

constexpr const char* kInk = "#2b2b33";
constexpr const char* kQuiet = "#7a7a86";
constexpr const char* kAlarm = "#d0021b";

/// Colour of a seam: the hues of neighbours in the list are far apart, and two lightnesses tell apart hues
/// that come close to each other again. Yellow to cyan are darker, for the white numbers on them.
std::string colour_of(int seam)
{
    const double hue = std::fmod(205.0 + seam * 137.508, 360.0);
    const double lightness = hue > 40.0 && hue < 190.0 ? 0.31 : 0.41;
    return svg::colour(hue, 0.7, lightness + (seam % 2 == 0 ? 0.0 : 0.09));
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Draws one report. Its methods append to the picture.
class Drawing {
public:
    explicit Drawing(const PatternReport& report)
        : report_(report), layout_(lay_out(report.panels, kMargin, kHeader))
    {
        for (const SeamFacts& seam : report.seams)
            twisted_ += seam.twisted() ? 1 : 0;
    }

    std::string draw()
    {
        const Vec2 size = layout_.size + Vec2(0.0, footer());
        text_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + svg::number(size.x()) +
                "mm\" height=\"" + svg::number(size.y()) + "mm\" viewBox=\"0 0 " + svg::number(size.x()) +
                " " + svg::number(size.y()) + "\" font-family=\"Helvetica, Arial, sans-serif\">\n" +
                "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
        grid(size);
        header();
        const auto panel_count = int(report_.panels.size());
        for (int p = 0; p < panel_count; ++p)
            outline(p, "fill=\"#fdf8ee\" stroke=\"none\"");
        for (size_t s = 0; s < report_.seams.size(); ++s)
            seam_lines(int(s));
        for (int p = 0; p < panel_count; ++p) {
            outline(p, std::string("fill=\"none\" stroke=\"") + kInk +
                           "\" stroke-width=\"1\" stroke-linejoin=\"round\"");
            inner_lines(p);
            panel_text(p);
            for (int e = 0; e < int(panel(p).edges.size()); ++e)
                edge_text(p, e);
        }
        for (size_t s = 0; s < report_.seams.size(); ++s)
            seam_badges(int(s));
        closures();
        twists();
        return text_ + "</svg>\n";
    }

private:
    const Panel& panel(int p) const { return report_.pattern.panels[size_t(p)]; }

    double footer() const { return twisted_ == 0 ? 0.0 : kFooterLine * (twisted_ + 1); }

    Vec2 at(int p, const EdgeCurve& curve, double fraction) const
    {
        return layout_.on_sheet(p, curve.at(fraction));
    }

    /// Direction of travel along an edge on the sheet, of unit length.
    Vec2 direction(int p, const EdgeCurve& curve, double fraction) const
    {
        const double step = 0.01;
        return (at(p, curve, std::min(1.0, fraction + step)) - at(p, curve, std::max(0.0, fraction - step)))
            .normalized();
    }

    /// Unit normal that points out of the panel.
    Vec2 outward(int p, const EdgeCurve& curve, double fraction) const
    {
        const Vec2 along = direction(p, curve, fraction);
        const double turns = signed_area(panel(p)) > 0.0 ? 1.0 : -1.0;
        return turns * Vec2(-along.y(), along.x());
    }

    void grid(const Vec2& size)
    {
        std::string fine;
        std::string bold;
        const auto add = [&](int i, const Vec2& from, const Vec2& to) {
            (i % 10 == 0 ? bold : fine) += "M" + svg::point(from) + " L" + svg::point(to) + " ";
        };
        for (int i = 0; 10.0 * i <= size.x(); ++i)
            add(i, {10.0 * i, 0.0}, {10.0 * i, size.y()});
        for (int i = 0; 10.0 * i <= size.y(); ++i)
            add(i, {0.0, 10.0 * i}, {size.x(), 10.0 * i});
        text_ += svg::path(fine, "stroke=\"#eef1f6\" stroke-width=\"0.5\"");
        text_ += svg::path(bold, "stroke=\"#dbe1ec\" stroke-width=\"0.8\"");
    }

    void header()
    {
        const std::string name = std::filesystem::path(report_.pattern.source).filename().string();
        text_ += svg::text({20.0, 22.0}, name, {18.0, kInk, "start", true});
        const std::string facts = std::to_string(report_.panels.size()) + " panels, " +
                                  short_text(report_.area()) + " m², " +
                                  std::to_string(report_.seams.size()) + " seams; grid 1 cm and 10 cm";
        text_ += svg::text({20.0, 43.0}, facts, {12.0, kQuiet, "start"});
    }

    // --- panels ---

    /// Path data of an edge from its start, which the pen has reached.
    std::string curve_data(int p, const garment::PanelEdge& edge) const
    {
        const std::string end = svg::point(layout_.on_sheet(p, panel(p).corners[size_t(edge.end)]));
        if (const auto* arc = std::get_if<garment::CircularArc>(&edge.curve)) {
            // y points down here: what turns counter-clockwise in the panel has the sweep flag 0.
            const std::string radius = svg::number(1000.0 * arc->radius);
            return "A" + radius + "," + radius + " 0 " + (arc->large ? "1" : "0") + " " +
                   (arc->counter_clockwise ? "0" : "1") + " " + end + " ";
        }
        const std::vector<Vec2>& controls = std::get<garment::Bezier>(edge.curve).controls;
        std::string data = controls.empty() ? "L" : controls.size() == 1 ? "Q" : "C";
        for (const Vec2& control : controls)
            data += svg::point(layout_.on_sheet(p, control)) + " ";
        return data + end + " ";
    }

    void outline(int p, const std::string& attributes)
    {
        std::string data =
            "M" + svg::point(layout_.on_sheet(p, panel(p).corners[size_t(panel(p).edges[0].start)])) + " ";
        for (const garment::PanelEdge& edge : panel(p).edges)
            data += curve_data(p, edge);
        text_ += svg::path(data + "Z", attributes);
    }

    /// Lines inside of a panel, dashed.
    void inner_lines(int p)
    {
        for (const garment::PanelLine& line : panel(p).lines) {
            std::string data;
            for (const Vec2& point : line.points)
                data += (data.empty() ? "M" : "L") + svg::point(layout_.on_sheet(p, point)) + " ";
            text_ += svg::path(data, std::string("fill=\"none\" stroke=\"") + kInk +
                                         "\" stroke-width=\"1\" stroke-dasharray=\"5 3\"");
        }
    }

    /// Points around a panel on the sheet.
    std::vector<Vec2> polygon(int p) const
    {
        constexpr int kSamples = 16;
        std::vector<Vec2> points;
        for (int e = 0; e < int(panel(p).edges.size()); ++e) {
            const EdgeCurve curve(panel(p), e);
            for (int i = 0; i < kSamples; ++i)
                points.push_back(at(p, curve, double(i) / kSamples));
        }
        return points;
    }

    /// Name, area and grain, in a large circle within the panel. Strips have no room for the area.
    void panel_text(int p)
    {
        const Circle room = large_circle(polygon(p));
        const std::string& name = panel(p).name;
        const bool is_strip = room.radius < kStrip;
        const double width = is_strip ? 500.0 * report_.panels[size_t(p)].box.sizes().x() : 1.7 * room.radius;
        const double size =
            std::clamp(std::min(width / (kLetter * double(name.size())), 0.3 * room.radius), 5.0, 17.0);
        text_ += svg::text(room.centre, name, {size, kInk, "middle", true});
        if (is_strip) {
            const Vec2 beside(0.5 * kLetter * double(name.size()) * size + 10.0, 0.0);
            grain(p, room.centre - beside, 0.9 * room.radius);
            return;
        }
        const std::string facts = std::to_string(std::lround(1e4 * report_.panels[size_t(p)].area)) + " cm²" +
                                  (panel(p).fabric.empty() ? "" : ", " + panel(p).fabric);
        text_ += svg::text(room.centre + Vec2(0.0, 1.15 * size), facts, {0.75 * size, kQuiet});
        const double length = std::min(0.8 * room.radius - 0.8 * size, 120.0);
        grain(p, room.centre - Vec2(0.0, 0.8 * size + 0.5 * length), length);
    }

    /// Arrow along the warp.
    void grain(int p, const Vec2& middle, double length)
    {
        if (length < 10.0)
            return;
        const double angle = panel(p).grain_deg * std::numbers::pi / 180.0;
        const Vec2 along(-std::sin(angle), -std::cos(angle));
        const Vec2 tip = middle + 0.5 * length * along;
        const Vec2 tail = middle - 0.5 * length * along;
        text_ += svg::line(tail, tip, kQuiet, 1.0);
        arrowhead(tip, along, 5.0, kQuiet);
        arrowhead(tail, -along, 5.0, kQuiet);
    }

    void arrowhead(const Vec2& tip, const Vec2& along, double size, const std::string& colour)
    {
        const Vec2 across(-along.y(), along.x());
        const Vec2 base = tip - size * along;
        text_ += svg::path("M" + svg::point(tip) + " L" + svg::point(base + 0.45 * size * across) + " L" +
                               svg::point(base - 0.45 * size * across) + " Z",
                           "fill=\"" + colour + "\"");
    }

    // --- edges ---

    /// Index and label outside an edge, along it. A label that is too long for its edge is left to the list.
    void edge_text(int p, int e)
    {
        const EdgeCurve curve(panel(p), e);
        const Vec2 along = direction(p, curve, 0.5);
        double turn = std::atan2(along.y(), along.x()) * 180.0 / std::numbers::pi;
        if (turn > 90.0 || turn <= -90.0)
            turn += turn > 0.0 ? -180.0 : 180.0;
        std::string text = std::to_string(e);
        const std::string& label = panel(p).edges[size_t(e)].label;
        const double room =
            0.9 * 1000.0 * curve.length() / (kLetter * double(text.size() + 2 + label.size()));
        const bool fits = !label.empty() && room > 4.0;
        if (fits)
            text += "  " + label;
        text_ += svg::text(at(p, curve, 0.5) + kLabelOffset * outward(p, curve, 0.5), text,
                           {fits ? std::min(8.0, room) : 8.0, kQuiet, "middle", false, fits, turn});
    }

    // --- seams ---

    std::string seam_colour(int seam) const
    {
        return report_.seams[size_t(seam)].twisted() ? kAlarm : colour_of(seam);
    }

    template <typename Action>
    void for_each_part(int seam, const Action& action)
    {
        for (const std::vector<EdgePart>* side :
             {&report_.pattern.seams[size_t(seam)].a, &report_.pattern.seams[size_t(seam)].b})
            for (const EdgePart& part : *side)
                action(part, EdgeCurve(panel(part.panel), part.edge));
    }

    void seam_lines(int seam)
    {
        constexpr int kSamples = 48;
        for_each_part(seam, [&](const EdgePart& part, const EdgeCurve& curve) {
            std::string data;
            for (int i = 0; i <= kSamples; ++i) {
                const double fraction = part.from + (part.to - part.from) * i / kSamples;
                data += (i == 0 ? "M" : "L") + svg::point(at(part.panel, curve, fraction)) + " ";
            }
            text_ += svg::path(
                data, "fill=\"none\" stroke-width=\"" + svg::number(kSeamWidth) + "\" stroke=\"" +
                          seam_colour(seam) + "\"" +
                          (report_.seams[size_t(seam)].twisted() ? " stroke-dasharray=\"9 5\"" : ""));
        });
    }

    /// Numbers, and arrows along the direction of sewing.
    void seam_badges(int seam)
    {
        const garment::SeamMeasure& measure = report_.seams[size_t(seam)].measure;
        const std::vector<EdgePart>& longer = measure.length_a >= measure.length_b
                                                  ? report_.pattern.seams[size_t(seam)].a
                                                  : report_.pattern.seams[size_t(seam)].b;
        for_each_part(seam, [&](const EdgePart& part, const EdgeCurve& curve) {
            const double length = 1000.0 * std::abs(part.to - part.from) * curve.length();
            if (length > 30.0)
                seam_arrows(part, curve);
            const double middle = 0.5 * (part.from + part.to);
            const double inset = length < kShort ? kShortInset : kBadgeInset;
            const Vec2 centre = at(part.panel, curve, middle) - inset * outward(part.panel, curve, middle);
            badge(centre, seam);
            const bool is_longer = &part >= longer.data() && &part < longer.data() + longer.size();
            if (is_longer && measure.ratio() >= kShownRatio && length > kRatioRoom)
                ratio_text(centre, measure.ratio(), outward(part.panel, curve, middle), seam_colour(seam));
        });
    }

    /// Gather beside a badge, on the side that is further in.
    void ratio_text(const Vec2& badge, double ratio, const Vec2& outward, const std::string& colour)
    {
        const bool leftwards = outward.x() > 0.3;
        text_ += svg::text(badge + Vec2((leftwards ? -1.4 : 1.4) * kBadgeRadius, 0.0),
                           "× " + short_text(ratio), {9.0, colour, leftwards ? "end" : "start", true});
    }

    void seam_arrows(const EdgePart& part, const EdgeCurve& curve)
    {
        const double sign = part.to > part.from ? 1.0 : -1.0;
        for (const double share : {0.25, 0.75}) {
            const double fraction = part.from + share * (part.to - part.from);
            const Vec2 along = sign * direction(part.panel, curve, fraction);
            arrowhead(at(part.panel, curve, fraction) + 0.5 * kArrow * along, along, kArrow, "#ffffff");
        }
    }

    void badge(const Vec2& centre, int seam)
    {
        text_ += "<circle cx=\"" + svg::number(centre.x()) + "\" cy=\"" + svg::number(centre.y()) +
                 "\" r=\"" + svg::number(kBadgeRadius) + "\" fill=\"" + seam_colour(seam) +
                 "\" stroke=\"#ffffff\"/>\n";
        text_ += svg::text(centre, std::to_string(seam), {9.0, "#ffffff", "middle", true});
    }

    /// Both ends of each closure as crossed circles with its number.
    void closures()
    {
        for (size_t c = 0; c < report_.pattern.closures.size(); ++c)
            for (const garment::PanelPoint* end :
                 {&report_.pattern.closures[c].a, &report_.pattern.closures[c].b}) {
                const Vec2 at = layout_.on_sheet(end->panel, end->point);
                const Vec2 across(kButtonRadius, 0.0), down(0.0, kButtonRadius);
                text_ += "<circle class=\"closure\" cx=\"" + svg::number(at.x()) + "\" cy=\"" +
                         svg::number(at.y()) + "\" r=\"" + svg::number(kButtonRadius) +
                         "\" fill=\"#ffffff\" stroke=\"" + kInk + "\"/>\n";
                text_ += svg::line(at - across, at + across, kInk, 0.7);
                text_ += svg::line(at - down, at + down, kInk, 0.7);
                text_ += svg::text(at + 2.0 * across, std::to_string(c), {8.0, kInk, "start", true});
            }
    }

    void twists()
    {
        double y = layout_.size.y() + 0.5 * kFooterLine;
        for (size_t s = 0; s < report_.seams.size(); ++s)
            if (report_.seams[s].twisted()) {
                text_ += svg::text({20.0, y}, twist_text(report_, int(s)), {11.0, kAlarm, "start"});
                y += kFooterLine;
            }
    }

    struct Circle {
        Vec2 centre;
        double radius;
    };

    static double distance_to(const std::vector<Vec2>& polygon, const Vec2& point)
    {
        double nearest = std::numeric_limits<double>::infinity();
        bool inside = false;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const Vec2& p = polygon[i];
            const Vec2& q = polygon[(i + 1) % polygon.size()];
            const Vec2 along = q - p;
            const double t = std::clamp((point - p).dot(along) / along.squaredNorm(), 0.0, 1.0);
            nearest = std::min(nearest, (point - p - t * along).norm());
            if ((p.y() > point.y()) != (q.y() > point.y()) &&
                (cross(along, point - p) > 0.0) == (q.y() > p.y()))
                inside = !inside;
        }
        return inside ? nearest : -nearest;
    }

    /// Large circle within a polygon, among centres on a grid: the one nearest to the middle of those that
    /// have almost the largest radius.
    static Circle large_circle(const std::vector<Vec2>& polygon)
    {
        constexpr int kCells = 40;
        constexpr double kAlmost = 0.9;
        Eigen::AlignedBox2d box;
        for (const Vec2& p : polygon)
            box.extend(p);
        std::vector<Circle> circles{{box.center(), 0.0}}; // for strips that the grid misses
        double largest = 0.0;
        for (int i = 1; i < kCells; ++i)
            for (int j = 1; j < kCells; ++j) {
                const Vec2 centre = box.min() + box.sizes().cwiseProduct(Vec2(i, j)) / kCells;
                circles.push_back({centre, distance_to(polygon, centre)});
                largest = std::max(largest, circles.back().radius);
            }
        std::erase_if(circles, [&](const Circle& circle) { return circle.radius < kAlmost * largest; });
        return *std::min_element(circles.begin(), circles.end(), [&](const Circle& a, const Circle& b) {
            return (a.centre - box.center()).norm() < (b.centre - box.center()).norm();
        });
    }

    const PatternReport& report_;
    Layout layout_;
    int twisted_ = 0;
    std::string text_;
};

} // namespace

std::string to_svg(const PatternReport& report) { return Drawing(report).draw(); }

} // namespace toile::app
