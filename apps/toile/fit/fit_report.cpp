#include "apps/toile/fit/fit_report.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

Json girth_json(const GirthFit& fit)
{
    Json json = {{"key", fit.body.key}};
    if (!fit.body.side.empty())
        json["side"] = fit.body.side;
    if (fit.lowered > 0.0)
        json["lowered_m"] = fit.lowered;
    json["point_m"] = vector_json(fit.body.skin.center);
    json["normal"] = vector_json(fit.body.plane.normal);
    json["body_m"] = fit.body.length;
    if (!fit.garment) {
        json["not_covered"] = fit.not_covered;
        return json;
    }
    json["garment_m"] = fit.garment->rest;
    json["garment_draped_m"] = fit.garment->draped;
    json["ease_m"] = fit.ease();
    json["ease_ratio"] = fit.ease() / fit.body.length;
    return json;
}

Json map_json(const VertexMap& map)
{
    const std::vector<double>& values = map.values;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const bool is_viridis = map.scale.map == preview::ColourMap::Viridis;
    return {{"name", map.name},
            {"unit", map.unit},
            {"min", *least},
            {"mean", std::accumulate(values.begin(), values.end(), 0.0) / double(values.size())},
            {"p99", quantile(values, 0.99)},
            {"max", *most},
            {"colours", is_viridis ? "viridis" : "turbo"},
            {"colour_range", {map.scale.low, map.scale.high}}};
}

Json fit_json(const GarmentFit& fit)
{
    Json json = {{"name", fit.garment.name}, {"girths", Json::array()}};
    for (const GirthFit& girth : fit.girths)
        json["girths"].push_back(girth_json(girth));
    if (!fit.not_measured.empty())
        json["not_measured"] = fit.not_measured;
    for (const VertexMap& map : fit.maps)
        json["maps"].push_back(map_json(map));
    return json;
}

std::string column(const VertexMap& map)
{
    std::string unit = map.unit;
    std::replace(unit.begin(), unit.end(), '/', '_');
    return map.name + (unit.empty() ? "" : "_" + unit);
}

} // namespace

GarmentFit fit_of(FittedGarment garment, const TriangleMesh& body, const std::string& body_source)
{
    GarmentFit fit;
    try {
        const avatars::UprightBody upright = avatars::find_upright_body(body, {}, body_source);
        fit.front = upright.world_from_body.col(2);
        fit.girths = fit_girths(garment.mesh, garment.rest, body, avatars::measure_girths(upright));
    } catch (const InvalidInput& error) {
        fit.not_measured = error.what(); // maps need no landmarks
    }
    fit.maps = {tension_map(garment), strain_map(garment), gap_map(garment, body)};
    fit.garment = std::move(garment);
    return fit;
}

std::string to_json(const std::vector<GarmentFit>& fits)
{
    Json json = {{"garments", Json::array()}};
    for (const GarmentFit& fit : fits)
        json["garments"].push_back(fit_json(fit));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_csv(const GarmentFit& fit)
{
    std::string text = "vertex";
    for (const VertexMap& map : fit.maps)
        (text += ',') += column(map);
    text += '\n';
    for (size_t v = 0; v < fit.garment.mesh.positions.size(); ++v) {
        text += std::to_string(v);
        for (const VertexMap& map : fit.maps) {
            char number[32];
            std::snprintf(number, sizeof number, ",%.6g", map.values[v]);
            text += number;
        }
        text += '\n';
    }
    return text;
}

} // namespace toile::app
