#include "apps/toile/caches/cloth_attributes.h"

#include "apps/toile/caches/exports.h"
#include "scenes/format/field.h"

namespace toile::app {

namespace {

using Kind = scene::ExportAttribute;

std::vector<Kind> kinds_of_vertices(const scene::Export& entry)
{
    std::vector<Kind> kinds;
    for (const Kind kind : entry.attributes)
        if (kind != Kind::Panel)
            kinds.push_back(kind);
    return kinds;
}

StrainMeter meter_of(const scenes::ClothState& state)
{
    return state.panels.empty() ? StrainMeter(state.rest.positions, state.triangles)
                                : StrainMeter(state.panels, state.triangles);
}

} // namespace

std::vector<std::string> vertex_attributes(const scene::Export& entry)
{
    std::vector<std::string> names;
    for (const Kind kind : kinds_of_vertices(entry))
        names.emplace_back(scene_format::word_of(kind));
    return names;
}

ClothAttributes::ClothAttributes(const scene::Export& entry, const scenes::ClothState& state)
    : kinds_(kinds_of_vertices(entry)), metres_per_unit_(axes_of(entry).metres_per_unit())
{
    if (entry.stores(Kind::Strain))
        strain_.emplace(meter_of(state), state.triangles);
}

std::vector<std::vector<double>> ClothAttributes::at(View<const Vec3> x, const SkinDistance* skin) const
{
    std::vector<std::vector<double>> values;
    for (const Kind kind : kinds_)
        values.push_back(kind == Kind::Gap ? gaps(x, *skin) : strain_->at(x));
    return values;
}

std::vector<double> ClothAttributes::gaps(View<const Vec3> x, const SkinDistance& skin) const
{
    std::vector<double> gaps = skin.at(x);
    for (double& gap : gaps)
        gap /= metres_per_unit_;
    return gaps;
}

} // namespace toile::app
