#include "apps/toile/simulate/start_text.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "scenes/world/start_pose.h"

namespace toile::app {

namespace {

using Kind = collision::StartDefect::Kind;

/// Maximum number of remaining defects that are listed.
constexpr int kMaxListed = 5;

std::string formatted(const char* format, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string millimetres(double metres) { return formatted("%.1f mm", 1e3 * metres); }

std::string number_of(int count, const std::string& one, const std::string& many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

scenes::NamedPart other_of(const collision::StartDefect& defect, const scenes::Scene& scene)
{
    return defect.is_with_body() ? scenes::body_of(scene, defect.other)
                                 : scenes::surface_of(scene, defect.other);
}

const char* verb_of(Kind kind)
{
    switch (kind) {
    case Kind::InsideBody:
        return "is inside";
    case Kind::UnderLayer:
        return "lies under";
    case Kind::CrossesBody:
    case Kind::Crossing:
        break;
    }
    return "crosses";
}

/// @param is_soft  the other is a soft body
const char* word_of(Kind kind, bool is_soft)
{
    switch (kind) {
    case Kind::InsideBody:
        return is_soft ? "inside_soft_body" : "inside_avatar";
    case Kind::CrossesBody:
        return is_soft ? "crosses_soft_body" : "crosses_avatar";
    case Kind::UnderLayer:
        return "under_layer";
    case Kind::Crossing:
        break;
    }
    return "crossing";
}

std::string line_of(const collision::StartDefect& defect, const scenes::Scene& scene)
{
    const Vec3& p = defect.position;
    const std::string at = " at (" + formatted("%.3f", p.x()) + ", " + formatted("%.3f", p.y()) + ", " +
                           formatted("%.3f", p.z()) + ") m";
    return scenes::surface_of(scene, defect.cloth).quoted() + " " + verb_of(defect.kind) + " " +
           other_of(defect, scene).quoted() + at + ", " + millimetres(defect.depth) + " deep" +
           (defect.is_fixed ? ", held there" : "");
}

/// At most kMaxListed.
std::vector<collision::StartDefect> deepest_remaining(const collision::StartReport& report)
{
    std::vector<collision::StartDefect> remaining;
    for (const collision::StartDefect& defect : report.defects)
        if (!defect.is_repaired)
            remaining.push_back(defect);
    std::stable_sort(remaining.begin(), remaining.end(),
                     [](const auto& a, const auto& b) { return a.depth > b.depth; });
    remaining.resize(std::min(remaining.size(), size_t(kMaxListed)));
    return remaining;
}

} // namespace

std::string start_text(const collision::StartReport& report, const scenes::Scene& scene)
{
    const bool has_soft_bodies = !scene.soft_bodies.empty();
    const std::string bodies = has_soft_bodies ? "avatars and soft bodies" : "avatars";
    if (report.defects.empty()) {
        const int near = report.vertices_too_near();
        return near == 0 ? ""
                         : "start pose: " + number_of(near, "vertex is", "vertices are") + " nearer to " +
                               bodies + " than the gap that contact keeps; " +
                               (scene.contact.repair_start ? "moved off before frame 0" : "left as it is");
    }
    const std::string surface = has_soft_bodies ? "surfaces" : "cloth";
    std::string text = "start pose: " + number_of(report.vertices_inside(), "vertex", "vertices") + " (" +
                       number_of(report.count(Kind::InsideBody), "penetration", "penetrations") +
                       " with edges and faces) inside " + bodies + ", up to " +
                       millimetres(report.deepest(Kind::InsideBody)) + " deep; " +
                       number_of(report.count(Kind::CrossesBody), "triangle", "triangles") + " of " +
                       surface + " crossing " + bodies + "; " +
                       number_of(report.count(Kind::Crossing), "crossing", "crossings") + " of " + surface +
                       " with " + surface + "; ";
    if (const int under = report.count(Kind::UnderLayer))
        text += number_of(under, "layer", "layers") + " under a lower one; ";
    if (!report.was_repaired)
        return text + (report.is_clean() ? "all of it is held, and left as it is" : "left as it is");
    if (report.max_move == 0.0)
        text += "no repair was found";
    else
        text += "repaired by moves of at most " + millimetres(report.max_move) + ", edges strained by " +
                formatted("%.1f %% (RMS), ", 100.0 * report.rms_strain) +
                formatted("%.1f %% at most", 100.0 * report.max_strain);
    const int crossing = report.remaining(Kind::CrossesBody) + report.remaining(Kind::Crossing);
    const int under = report.remaining(Kind::UnderLayer);
    const int left = report.remaining(Kind::InsideBody) + crossing + under;
    if (left == 0)
        return text + "; nothing remains";
    text += "; " + number_of(report.remaining(Kind::InsideBody), "penetration", "penetrations") + " and " +
            number_of(crossing, "crossing", "crossings") +
            (under > 0 ? " and " + number_of(under, "misplaced layer", "misplaced layers") : "") + " remain:";
    for (const collision::StartDefect& defect : deepest_remaining(report))
        text += "\n  " + line_of(defect, scene);
    return left > kMaxListed ? text + "\n  ... (all of them: --report)" : text;
}

nlohmann::ordered_json start_json(const collision::StartReport& report, const scenes::Scene& scene)
{
    nlohmann::ordered_json json = {{"repaired", report.max_move > 0.0},
                                   {"vertices_inside", report.vertices_inside()},
                                   {"places_inside", report.count(Kind::InsideBody)},
                                   {"avatar_crossings", report.count(Kind::CrossesBody)},
                                   {"crossings", report.count(Kind::Crossing)},
                                   {"places_inside_remaining", report.remaining(Kind::InsideBody)},
                                   {"avatar_crossings_remaining", report.remaining(Kind::CrossesBody)},
                                   {"crossings_remaining", report.remaining(Kind::Crossing)},
                                   {"layers_under", report.count(Kind::UnderLayer)},
                                   {"layers_under_remaining", report.remaining(Kind::UnderLayer)},
                                   {"max_depth_m", report.deepest(Kind::InsideBody)},
                                   {"max_strain", report.max_strain},
                                   {"rms_strain", report.rms_strain},
                                   {"max_move_m", report.max_move},
                                   {"vertices_too_near", report.vertices_too_near()}};
    nlohmann::ordered_json& defects = json["places"] = nlohmann::ordered_json::array();
    for (const collision::StartDefect& defect : report.defects) {
        const scenes::NamedPart other = other_of(defect, scene);
        nlohmann::ordered_json vertices = nlohmann::ordered_json::array();
        for (int k = 0; k < 3 && defect.vertex[k] >= 0; ++k)
            vertices.push_back(defect.vertex[k]);
        defects.push_back({{"kind", word_of(defect.kind, other.kind == "soft body")},
                           {"position_m", {defect.position.x(), defect.position.y(), defect.position.z()}},
                           {"depth_m", defect.depth},
                           {"cloth", scenes::surface_of(scene, defect.cloth).name},
                           {"other", other.name},
                           {"vertices", vertices},
                           {"held", defect.is_fixed},
                           {"repaired", defect.is_repaired}});
    }
    return json;
}

} // namespace toile::app
