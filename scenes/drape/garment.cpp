#include "scenes/drape/garment.h"

#include <algorithm>

#include "core/base/error.h"
#include "scenes/garment_format/read_garment.h"

namespace toile::scenes {

namespace {

std::string common_fabric(const garment::Pattern& pattern, const DrapeGarment& settings)
{
    std::string common;
    for (const garment::Panel& panel : pattern.panels) {
        const std::string& fabric = panel.fabric.empty() ? settings.fabric : panel.fabric;
        if (common.empty())
            common = fabric;
        if (fabric != common)
            throw InvalidInput(settings.file.string() + ": panel \"" + panel.name + "\" is of " + fabric +
                               " and others of " + common +
                               "; a garment can be draped in one fabric, give all panels the same");
    }
    return common;
}

} // namespace

Garment::Garment(const DrapeGarment& from, const Vec3& shift)
    : settings(from), pattern(garment_format::read_pattern(from.file)), fabric(common_fabric(pattern, from))
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

std::vector<std::string> Garment::not_used() const
{
    std::vector<std::string> texts;
    for (const garment::Seam& seam : pattern.seams)
        if (seam.fold_deg != 0.0)
            texts.push_back(seam.name + ": fold_deg is not used: seams are sewn flat");
    return texts;
}

bool Garment::is_placed_by_segments() const
{
    return std::any_of(pattern.panels.begin(), pattern.panels.end(),
                       [](const garment::Panel& panel) { return panel.place.has_value(); });
}

} // namespace toile::scenes
