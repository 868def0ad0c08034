#include "apps/toile/drape/drape_report.h"

#include <algorithm>
#include <cstdio>

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

/// Panel of the first condition that fails: crossings, then depth, then strain; empty if none is at a place.
std::string panel_of_defect(const Certificate& certificate, const ObjMesh& garment)
{
    if (certificate.first_crossing)
        return panel_near(garment, certificate.first_crossing->point);
    if (certificate.worst.penetration > certificate.limits.penetration)
        return panel_near(garment, certificate.worst.penetration_point);
    return certificate.worst.strain > 0.0 ? panel_near(garment, certificate.worst.strain_point) : "";
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

std::string counted(int count, const std::string& thing)
{
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

} // namespace

DrapeVerdict verdict_of(const scenes::DrapeResult& result)
{
    return {to_word(result.outcome), result.message};
}

DrapeVerdict verdict_of(const Certificate& certificate, const ObjMesh& garment)
{
    if (certificate.holds())
        return {"draped", ""};
    const std::string panel = panel_of_defect(certificate, garment);
    return {"solver",
            "the garment rests, but its certificate does not hold: " + certificate.first_bad_reason +
                (panel.empty() ? "" : ", in panel \"" + panel + "\"")};
}

std::string to_json(const DrapeReport& report, const garment::Pattern& pattern)
{
    const scenes::DrapeResult& result = report.result;
    Json json = {{"class", report.verdict.word}, {"message", report.verdict.message}};
    json["stages"] = Json::array();
    for (const scenes::DrapeStage& stage : result.stages)
        json["stages"].push_back({{"name", stage.name},
                                  {"seconds", stage.seconds},
                                  {"frames", stage.frames},
                                  {"steps", stage.steps},
                                  {"vertices", stage.vertices}});
    json["lift_m"] = result.lift;
    json["vertices"] = result.surface.mesh.positions.size();
    json["triangles"] = result.surface.mesh.polygons.size();
    json["pieces"] = result.pieces;
    json["border_loops"] = result.border_loops;
    json["euler_characteristic"] = result.euler_characteristic;
    json["seams"] = seams_json(pattern, result.seams);
    json["slid_m"] = Json::object();
    for (const scenes::DrapeSlide& slide : result.slides)
        json["slid_m"][slide.label] = slide.slid;
    json["rest_speed_m_s"] = result.rest_speed;
    if (report.measures) {
        const UvStretch& uv = report.measures->uv;
        json["strain"] = strain_json(report.measures->strains);
        json["uv_distortion"] = {
            {"l2_stretch", uv.l2}, {"linf_stretch", uv.linf}, {"area_ratio", uv.area_ratio}};
    }
    return dump(json);
}

std::string to_json(const DrapeVerdict& verdict)
{
    return dump({{"class", verdict.word}, {"message", verdict.message}});
}

std::string summary_of(const DrapeReport& report)
{
    const scenes::DrapeResult& result = report.result;
    double seconds = 0.0;
    for (const scenes::DrapeStage& stage : result.stages)
        seconds += stage.seconds;
    char text[160];
    std::snprintf(text, sizeof text, "%s after %.1f s: ", report.verdict.word.c_str(), seconds);
    std::string summary = text + std::to_string(result.surface.mesh.positions.size()) + " vertices, " +
                          counted(result.pieces, "piece") + ", " +
                          counted(result.border_loops, "border loop");
    if (!result.seams.empty()) {
        const auto widest = std::max_element(result.seams.begin(), result.seams.end(),
                                             [](const auto& a, const auto& b) { return a.gap < b.gap; });
        std::snprintf(text, sizeof text, ", widest seam gap %.2g mm", 1e3 * widest->gap);
        summary += text;
    }
    if (!report.measures)
        return summary;
    for (const FabricStrain& strain : report.measures->strains) {
        std::snprintf(text, sizeof text, " strained by %.3g %% at most, %.3g %% at p99, %.3g %% in the mean",
                      1e2 * strain.max, 1e2 * strain.p99, 1e2 * strain.mean);
        summary += "\n" + strain.fabric + text + "; most in panel \"" + strain.max_panel + "\"";
    }
    const UvStretch& uv = report.measures->uv;
    std::snprintf(text, sizeof text, "\nuv distortion: L2 stretch %.4f, Linf %.4f, area %.4f of the panels'",
                  uv.l2, uv.linf, uv.area_ratio);
    return summary + text;
}

} // namespace toile::app
