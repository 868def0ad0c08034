#include "scenes/garment_format/copies.h"

#include <algorithm>

#include "garment/pattern/edge_curve.h"

namespace toile::garment_format {
namespace {

using garment::BodySegment;
using garment::EdgePart;
using garment::Panel;
using garment::Pattern;
using garment::Seam;

/// [m] Distance of a copy from the one before it on its side of the body.
constexpr double kApart = 0.01;

Vec2 mirrored(const Vec2& point) { return {-point.x(), point.y()}; }

std::string mirrored(const std::string& label)
{
    for (const auto& [from, to] :
         {std::pair<std::string, std::string>{"left_", "right_"}, {"right_", "left_"}})
        if (label.starts_with(from))
            return to + label.substr(from.size());
    return label;
}

BodySegment mirrored(BodySegment segment)
{
    switch (segment) {
    case BodySegment::LeftArm:
        return BodySegment::RightArm;
    case BodySegment::RightArm:
        return BodySegment::LeftArm;
    case BodySegment::LeftLeg:
        return BodySegment::RightLeg;
    case BodySegment::RightLeg:
        return BodySegment::LeftLeg;
    case BodySegment::Torso:
    case BodySegment::Neck:
        break;
    }
    return segment;
}

/// Both the mirror and the reversal swap the side on which an arc bulges: it turns as before.
garment::PanelEdge mirrored(const garment::PanelEdge& edge)
{
    garment::PanelEdge image = edge;
    std::swap(image.start, image.end);
    image.label = mirrored(edge.label);
    if (auto* bezier = std::get_if<garment::Bezier>(&image.curve)) {
        std::reverse(bezier->controls.begin(), bezier->controls.end());
        for (Vec2& control : bezier->controls)
            control = mirrored(control);
    }
    return image;
}

/// Part of the mirror image that lies where `part` did.
EdgePart mirrored(const EdgePart& part, const Panel& panel)
{
    if (line_of(panel, part.edge))
        return part;
    return {part.panel, int(panel.edges.size()) - 1 - part.edge, 1.0 - part.from, 1.0 - part.to};
}

Panel copy_of(const Panel& panel, int k, const Cut& cut)
{
    Panel copy = panel;
    copy.placement.pretranslate(kApart * (cut.mirror ? k / 2 : k) * outward(panel));
    if (cut.mirror && k % 2 == 1)
        copy = mirror_image(copy);
    copy.name = name_of_copy(panel.name, k);
    return copy;
}

/// Repeats a chain on the k-th copies.
std::vector<EdgePart> copy_of(const std::vector<EdgePart>& chain, int k, const std::vector<Cut>& cuts,
                              const std::vector<int>& first_copy, const Pattern& pattern)
{
    std::vector<EdgePart> copies;
    for (const EdgePart& part : chain) {
        const auto panel = size_t(part.panel);
        EdgePart copy = cuts[panel].mirror && k % 2 == 1 ? mirrored(part, pattern.panels[panel]) : part;
        copy.panel = first_copy[panel] + k - 1;
        copies.push_back(copy);
    }
    return copies;
}

/// Copies of the panels of a seam, if they are all cut equally; 1 otherwise.
int common_copies(const Seam& seam, const std::vector<Cut>& cuts)
{
    const Cut& first = cuts[size_t(seam.a.front().panel)];
    for (const std::vector<EdgePart>* chain : {&seam.a, &seam.b})
        for (const EdgePart& part : *chain) {
            const Cut& cut = cuts[size_t(part.panel)];
            if (cut.copies != first.copies || cut.mirror != first.mirror)
                return 1;
        }
    return first.copies;
}

} // namespace

std::string name_of_copy(const std::string& panel, int k)
{
    return k == 0 ? panel : panel + "_" + std::to_string(k + 1);
}

Panel mirror_image(const Panel& panel)
{
    Panel image = panel;
    for (Vec2& corner : image.corners)
        corner = mirrored(corner);
    std::transform(panel.edges.rbegin(), panel.edges.rend(), image.edges.begin(),
                   [](const garment::PanelEdge& edge) { return mirrored(edge); });
    for (garment::PanelLine& line : image.lines)
        for (Vec2& point : line.points)
            point = mirrored(point);
    image.label = mirrored(panel.label);
    image.grain_deg = -panel.grain_deg;

    // The image of M P(x, y), M the mirror of the world, is M P M applied to (-x, y).
    const Eigen::Matrix3d mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
    image.placement.linear() = mirror * panel.placement.linear() * mirror;
    image.placement.translation() = mirror * panel.placement.translation();
    if (image.place) {
        image.place->at = mirrored(panel.place->at);
        image.place->angle_deg = -panel.place->angle_deg;
    }
    return image;
}

void add_copies(Pattern& pattern, const std::vector<Cut>& cuts)
{
    const size_t panel_count = pattern.panels.size();
    std::vector<int> first_copy(panel_count, 0);
    for (size_t i = 0; i < panel_count; ++i) {
        first_copy[i] = int(pattern.panels.size());
        for (int k = 1; k < cuts[i].copies; ++k) {
            Panel copy = copy_of(pattern.panels[i], k, cuts[i]);
            pattern.panels.push_back(std::move(copy));
        }
    }
    const size_t seam_count = pattern.seams.size();
    for (size_t s = 0; s < seam_count; ++s)
        for (int k = 1; k < common_copies(pattern.seams[s], cuts); ++k) {
            Seam copy = pattern.seams[s];
            copy.a = copy_of(pattern.seams[s].a, k, cuts, first_copy, pattern);
            copy.b = copy_of(pattern.seams[s].b, k, cuts, first_copy, pattern);
            copy.name += " of copy " + std::to_string(k + 1);
            pattern.seams.push_back(std::move(copy));
        }
}

} // namespace toile::garment_format
