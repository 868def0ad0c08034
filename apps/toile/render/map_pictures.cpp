#include "apps/toile/render/map_pictures.h"

#include <algorithm>
#include <array>
#include <utility>

#include <CLI/CLI.hpp>

#include "apps/preview/value_view.h"
#include "apps/toile/cloth/skin.h"
#include "apps/toile/render/number_list.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"

namespace toile::app {

namespace {

constexpr std::array<std::pair<const char*, MapKind>, 4> kMaps{{{"strain", MapKind::Strain},
                                                                {"tension", MapKind::Tension},
                                                                {"gap", MapKind::Gap},
                                                                {"pressure", MapKind::Pressure}}};

} // namespace

void MapOptions::add_to(CLI::App& parser)
{
    parser.add_option("--map", name_, "Colours of strain, tension, gap or pressure, with a legend");
    parser.add_option("--map-range", range_, "LO,HI of the colours in the legend's unit [of all pictures]");
}

void MapOptions::require_valid() const
{
    if (is_given())
        kind();
    else if (!range_.empty())
        throw InvalidInput("--map-range: needs --map strain, tension, gap or pressure");
    range();
}

MapKind MapOptions::kind() const
{
    for (const auto& [name, kind] : kMaps)
        if (name_ == name)
            return kind;
    throw InvalidInput("--map: \"" + name_ + "\" is unknown; give strain, tension, gap or pressure");
}

std::optional<std::vector<double>> MapOptions::range() const
{
    if (range_.empty())
        return std::nullopt;
    auto ends = numbers_of(range_, 2);
    if (!ends || !((*ends)[0] < (*ends)[1]))
        throw InvalidInput("--map-range: \"" + range_ +
                           "\" is no range; write LO,HI with two numbers, the smaller one first");
    return ends;
}

MapPictures::MapPictures(Film& film, const MapOptions& options, bool quiet)
    : film_(film), kind_(options.kind()), cloths_(film.settings().cloths.size())
{
    const std::string source = film.settings().source.string();
    const int first = film.shots().front().frame;
    for (const Film::Cloth& cloth : film.cloths(first))
        cloths_[size_t(cloth.index)] = unattached_cloth(film.settings(), size_t(cloth.index));
    if (film.cloths(first).empty())
        throw InvalidInput("--map: " + source + " has no cloth in the picture; maps show cloths");
    if (needs_body(kind_) && film.skin(first).triangles.empty())
        throw InvalidInput("--map: " + source + " has no avatar with a skin; gap and pressure need one");

    const VertexMap map = maps(first).front().map;
    legend_ = {map.name + " (" + map.shown_unit + ")", map.scale, map.shown_per_value};
    if (const auto range = options.range()) {
        legend_.scale.low = (*range)[0] / map.shown_per_value;
        legend_.scale.high = (*range)[1] / map.shown_per_value;
        return;
    }
    Progress progress("range", int(film.shots().size()), quiet);
    for (size_t i = 0; i < film.shots().size(); ++i) {
        const int frame = film.shots()[i].frame;
        if (i == 0 || film.shots()[i - 1].frame != frame)
            for (const ClothMap& shown : maps(frame))
                legend_.scale.high = std::max(legend_.scale.high, shown.map.scale.high);
        progress.update(int(i) + 1);
    }
}

std::vector<MapPictures::ClothMap> MapPictures::maps(int frame)
{
    const TriangleMesh skin = needs_body(kind_) ? film_.skin(frame) : TriangleMesh{};
    std::vector<ClothMap> maps;
    for (Film::Cloth& cloth : film_.cloths(frame)) {
        FittedGarment garment = fitted_garment(cloths_[size_t(cloth.index)].value(), std::move(cloth.now));
        VertexMap map = map_of(kind_, garment, skin);
        maps.push_back({std::move(garment.mesh), std::move(map)});
    }
    return maps;
}

preview::Image MapPictures::picture(size_t shot)
{
    const int frame = film_.shots()[shot].frame;
    TriangleMesh cloths;
    std::vector<double> values;
    for (const ClothMap& shown : maps(frame)) {
        append(cloths, shown.cloth.positions, shown.cloth.triangles);
        values.insert(values.end(), shown.map.values.begin(), shown.map.values.end());
    }
    TriangleMesh around = film_.skin(frame);
    const TriangleMesh solids = film_.solids(frame);
    append(around, solids.positions, solids.triangles);
    const PictureSize size = film_.picture_size();
    return preview::ValueView(cloths, around, film_.camera(shot), size.width, size.height)
        .picture(values, legend_.scale);
}

} // namespace toile::app
