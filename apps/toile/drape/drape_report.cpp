#include "apps/toile/drape/drape_report.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <nlohmann/json.hpp>

#include "garment/pattern/seam_measure.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;

const char* to_word(scenes::DrapeOutcome outcome)
{
    switch (outcome) {
    case scenes::DrapeOutcome::Meshing:
        return "meshing";
    case scenes::DrapeOutcome::Placement:
        return "placement";
    case scenes::DrapeOutcome::Tangled:
        return "tangled";
    case scenes::DrapeOutcome::NotAtRest:
        return "not at rest";
    case scenes::DrapeOutcome::SlidOff:
        return "slid off";
    case scenes::DrapeOutcome::Solver:
        return "solver";
    case scenes::DrapeOutcome::Draped:
        break;
    }
    return "draped";
}

/// Place of the first condition that fails: crossings, then depth, then strain.
std::optional<Vec3> defect_point(const Certificate& certificate)
{
    if (certificate.first_crossing)
        return certificate.first_crossing->point;
    if (certificate.worst.penetration > certificate.limits.penetration)
        return certificate.worst.penetration_point;
    return certificate.first_overstretch ? std::optional(certificate.first_overstretch->point) : std::nullopt;
}

/// Panel at a point, for messages; empty if there is none.
std::string panel_text(const std::vector<scenes::DrapedGarment>& garments, const Vec3& point)
{
    NearPanel nearest;
    std::string garment;
    for (const scenes::DrapedGarment& draped : garments) {
        const NearPanel near = panel_near(draped.surface.mesh, point);
        if (near.distance >= nearest.distance)
            continue;
        nearest = near;
        garment = draped.name;
    }
    if (nearest.name.empty())
        return "";
    return ", in panel \"" + nearest.name + "\"" + (garments.size() > 1 ? " of " + garment : "");
}

/// Seams of the pattern. Those that were not sewn have no gap.
Json seams_json(const garment::Pattern& pattern, const std::vector<scenes::DrapeSeam>& sewn)
{
    Json json = Json::array();
    for (size_t s = 0; s < pattern.seams.size(); ++s) {
        const garment::Seam& seam = pattern.seams[s];
        const bool is_sewn = s < sewn.size() && sewn[s].name == seam.name;
        json.push_back({{"name", seam.name},
                        {"ratio", garment::measure_seam(pattern, seam).ratio()},
                        {"gap_before_weld_m", is_sewn ? Json(sewn[s].gap) : Json(nullptr)}});
    }
    return json;
}

Json strain_json(const std::vector<FabricStrain>& strains)
{
    Json json = Json::object();
    for (const FabricStrain& strain : strains) {
        const Vec3& at = strain.max_point;
        json[strain.fabric] = {{"max", strain.max},
                               {"max_panel", strain.max_panel},
                               {"max_point_m", {at.x(), at.y(), at.z()}},
                               {"p99", strain.p99},
                               {"mean", strain.mean}};
    }
    return json;
}

std::string dump(const Json& json)
{
    // Names of files may have bytes that are not UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// @param pattern   of the garment
/// @param measures  null without a mesh
Json garment_json(const scenes::DrapedGarment& garment, const garment::Pattern& pattern,
                  const GarmentMeasures* measures)
{
    Json json = {{"name", garment.name}};
    json["stages"] = Json::array();
    for (const scenes::DrapeStage& stage : garment.stages)
        json["stages"].push_back({{"name", stage.name},
                                  {"seconds", stage.seconds},
                                  {"frames", stage.frames},
                                  {"steps", stage.steps},
                                  {"vertices", stage.vertices}});
    json["lift_m"] = garment.lift;
    json["vertices"] = garment.surface.mesh.positions.size();
    json["triangles"] = garment.surface.mesh.polygons.size();
    json["pieces"] = garment.pieces;
    json["border_loops"] = garment.border_loops;
    json["euler_characteristic"] = garment.euler_characteristic;
    json["seams"] = seams_json(pattern, garment.seams);
    json["closures"] = Json::array();
    for (const scenes::DrapeClosure& closure : garment.closures)
        json["closures"].push_back({{"name", closure.name}, {"gap_m", closure.gap}});
    json["slid_m"] = Json::object();
    for (const scenes::DrapeSlide& slide : garment.slides)
        json["slid_m"][slide.label] = slide.slid;
    if (measures) {
        const UvStretch& uv = measures->uv;
        json["strain"] = strain_json(measures->strains);
        json["uv_distortion"] = {
            {"l2_stretch", uv.l2}, {"linf_stretch", uv.linf}, {"area_ratio", uv.area_ratio}};
    }
    return json;
}

std::string counted(int count, const std::string& thing)
{
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string summary_of(const scenes::DrapedGarment& garment)
{
    std::string summary = std::to_string(garment.surface.mesh.positions.size()) + " vertices, " +
                          counted(garment.pieces, "piece") + ", " +
                          counted(garment.border_loops, "border loop");
    if (garment.seams.empty())
        return summary;
    const auto widest = std::max_element(garment.seams.begin(), garment.seams.end(),
                                         [](const auto& a, const auto& b) { return a.gap < b.gap; });
    char text[80];
    std::snprintf(text, sizeof text, ", widest seam gap %.2g mm", 1e3 * widest->gap);
    return summary + text;
}

std::string summary_of(const GarmentMeasures& measures)
{
    char text[160];
    std::string summary;
    for (const FabricStrain& strain : measures.strains) {
        std::snprintf(text, sizeof text, " strained by %.3g %% at most, %.3g %% at p99, %.3g %% in the mean",
                      1e2 * strain.max, 1e2 * strain.p99, 1e2 * strain.mean);
        summary += "\n" + strain.fabric + text + "; most in panel \"" + strain.max_panel + "\"";
    }
    const UvStretch& uv = measures.uv;
    std::snprintf(text, sizeof text, "\nuv distortion: L2 stretch %.4f, Linf %.4f, area %.4f of the panels'",
                  uv.l2, uv.linf, uv.area_ratio);
    return summary + text;
}

} // namespace

DrapeVerdict verdict_of(const scenes::DrapeResult& result)
{
    return {to_word(result.outcome), result.message};
}

DrapeVerdict verdict_of(const Certificate& certificate, const std::vector<scenes::DrapedGarment>& garments)
{
    if (certificate.holds())
        return {"draped", ""};
    const std::optional<Vec3> point = defect_point(certificate);
    return {"solver", "at rest, but the certificate does not hold: " + certificate.first_bad_reason +
                          (point ? panel_text(garments, *point) : "")};
}

std::string to_json(const DrapeReport& report, const std::vector<garment::Pattern>& patterns)
{
    const std::vector<scenes::DrapedGarment>& garments = report.result.garments;
    Json json = {{"class", report.verdict.word}, {"message", report.verdict.message}};
    json["rest_speed_m_s"] = report.result.rest_speed ? Json(*report.result.rest_speed) : Json(nullptr);
    for (size_t g = 0; g < garments.size(); ++g) {
        const Json garment = garment_json(garments[g], patterns[g],
                                          g < report.measures.size() ? &report.measures[g] : nullptr);
        if (patterns.size() == 1)
            json.update(garment);
        else
            json["garments"].push_back(garment);
    }
    return dump(json);
}

std::string to_json(const DrapeVerdict& verdict)
{
    return dump({{"class", verdict.word}, {"message", verdict.message}});
}

std::string summary_of(const DrapeReport& report)
{
    const std::vector<scenes::DrapedGarment>& garments = report.result.garments;
    double seconds = 0.0;
    for (const scenes::DrapedGarment& garment : garments)
        for (const scenes::DrapeStage& stage : garment.stages)
            seconds += stage.seconds;
    char text[80];
    std::snprintf(text, sizeof text, "%s after %.1f s:", report.verdict.word.c_str(), seconds);
    std::string summary = text;
    for (size_t g = 0; g < garments.size(); ++g) {
        summary += garments.size() > 1 ? "\n" + garments[g].name + ": " : " ";
        summary += summary_of(garments[g]);
        if (g < report.measures.size())
            summary += summary_of(report.measures[g]);
    }
    return summary;
}

} // namespace toile::app
