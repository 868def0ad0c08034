#include "apps/toile/start_text.h"

#include <cstdio>

namespace toile {

namespace {

using Kind = StartPlace::Kind;

/// Remaining places that are listed one by one.
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

/// What a place met: an avatar, or a cloth.
const std::string& other_of(const StartPlace& place, const Scene& scene)
{
    return place.kind == Kind::InsideBody ? scene.avatars[place.other].name : scene.cloths[place.other].name;
}

std::string line_of(const StartPlace& place, const Scene& scene)
{
    const Vec3& p = place.position;
    const std::string at = " at (" + formatted("%.3f", p.x()) + ", " + formatted("%.3f", p.y()) + ", " +
                           formatted("%.3f", p.z()) + ") m";
    return "cloth \"" + scene.cloths[place.cloth].name + "\"" +
           (place.kind == Kind::InsideBody ? " is inside avatar \"" : " crosses cloth \"") +
           other_of(place, scene) + "\"" + at + ", " + millimetres(place.depth) + " deep" +
           (place.is_held ? ", held there" : "");
}

} // namespace

std::string start_text(const StartReport& report, const Scene& scene)
{
    if (report.places.empty())
        return "";
    std::string text = "start pose: " + number_of(report.vertices_inside(), "vertex", "vertices") + " (" +
                       number_of(report.count(Kind::InsideBody), "place", "places") +
                       " with edges and faces) inside avatars, up to " +
                       millimetres(report.deepest(Kind::InsideBody)) + " deep; " +
                       number_of(report.count(Kind::Crossing), "crossing", "crossings") +
                       " of cloth with cloth; ";
    if (!report.was_repaired)
        return text + "left as it is";
    text += "repaired by moves of at most " + millimetres(report.max_move) + ", edges strained by " +
            formatted("%.1f %% (RMS), ", 100.0 * report.rms_strain) +
            formatted("%.1f %% at most", 100.0 * report.max_strain);
    const int left = report.remaining(Kind::InsideBody) + report.remaining(Kind::Crossing);
    if (left == 0)
        return text + "; nothing remains";
    text += "; " + number_of(report.remaining(Kind::InsideBody), "place", "places") + " and " +
            number_of(report.remaining(Kind::Crossing), "crossing", "crossings") + " remain:";
    int listed = 0;
    for (const StartPlace& place : report.places)
        if (!place.is_repaired && listed++ < kMaxListed)
            text += "\n  " + line_of(place, scene);
    return left > kMaxListed ? text + "\n  ... (all of them: --report)" : text;
}

nlohmann::ordered_json start_json(const StartReport& report, const Scene& scene)
{
    nlohmann::ordered_json json = {{"repaired", report.was_repaired},
                                   {"vertices_inside", report.vertices_inside()},
                                   {"places_inside", report.count(Kind::InsideBody)},
                                   {"crossings", report.count(Kind::Crossing)},
                                   {"places_inside_remaining", report.remaining(Kind::InsideBody)},
                                   {"crossings_remaining", report.remaining(Kind::Crossing)},
                                   {"max_depth_m", report.deepest(Kind::InsideBody)},
                                   {"max_strain", report.max_strain},
                                   {"rms_strain", report.rms_strain},
                                   {"max_move_m", report.max_move}};
    nlohmann::ordered_json& places = json["places"] = nlohmann::ordered_json::array();
    for (const StartPlace& place : report.places) {
        nlohmann::ordered_json vertices = nlohmann::ordered_json::array();
        for (int k = 0; k < 3 && place.vertex[k] >= 0; ++k)
            vertices.push_back(place.vertex[k]);
        places.push_back({{"kind", place.kind == Kind::InsideBody ? "inside_avatar" : "crossing"},
                          {"position_m", {place.position.x(), place.position.y(), place.position.z()}},
                          {"depth_m", place.depth},
                          {"cloth", scene.cloths[place.cloth].name},
                          {"other", other_of(place, scene)},
                          {"vertices", vertices},
                          {"held", place.is_held},
                          {"repaired", place.is_repaired}});
    }
    return json;
}

} // namespace toile
