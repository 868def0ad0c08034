#include "scenes/drape/garment.h"

#include <algorithm>

#include "scenes/garment_format/read_garment.h"

namespace toile::scenes {

namespace {

std::string main_fabric(const garment::Pattern& pattern, const DrapeGarment& settings)
{
    for (const garment::Panel& panel : pattern.panels)
        if (panel.fabric.empty())
            return settings.fabric;
    return pattern.panels.front().fabric;
}

} // namespace

Garment::Garment(const DrapeGarment& from, const Vec3& shift)
    : settings(from), pattern(garment_format::read_pattern(from.file)), fabric(main_fabric(pattern, from))
{
    for (garment::Panel& panel : pattern.panels)
        panel.placement.pretranslate(shift);
}

std::set<std::string> Garment::labels() const
{
    std::set<std::string> labels;
    for (const garment::Panel& panel : pattern.panels)
        for (const garment::PanelEdge& edge : panel.edges)
            if (!edge.label.empty())
                labels.insert(edge.label);
    return labels;
}

std::map<std::string, std::string> Garment::panel_fabrics() const
{
    std::map<std::string, std::string> fabrics;
    for (const garment::Panel& panel : pattern.panels)
        if (!panel.fabric.empty() && panel.fabric != fabric)
            fabrics[panel.name] = panel.fabric;
    return fabrics;
}

bool Garment::is_placed_by_segments() const
{
    return std::any_of(pattern.panels.begin(), pattern.panels.end(),
                       [](const garment::Panel& panel) { return panel.place.has_value(); });
}

} // namespace toile::scenes
