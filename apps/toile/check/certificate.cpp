#include "apps/toile/check/certificate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "apps/toile/caches/written_exports.h"
#include "apps/toile/terminal/version.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;

std::string near_text(const Vec3& p)
{
    char text[80];
    std::snprintf(text, sizeof text, "near (%.3f, %.3f, %.3f) m", p.x(), p.y(), p.z());
    return text;
}

/// Defects of a frame in words; empty for none.
std::string reason_of(const FrameFindings& found, const CertificateLimits& limits)
{
    std::string reason;
    const auto add = [&](const std::string& text) { reason += (reason.empty() ? "" : ", ") + text; };
    char text[160];
    if (found.out_of_range > 0)
        add(std::to_string(found.out_of_range) + " vertices are not finite, or farther than 100 km away");
    if (found.torn > 0)
        add(std::to_string(found.torn) + " vertices have left the ones that they are joined to");
    if (found.cloth_cloth_crossings > 0)
        add(std::to_string(found.cloth_cloth_crossings) + " crossings");
    if (found.cloth_avatar_crossings > 0)
        add(std::to_string(found.cloth_avatar_crossings) + " crossings with avatars");
    if (found.crossing) {
        const auto& [frame, a, b, point] = *found.crossing;
        add("the first of \"" + a.name + "\" with " + (b.name == a.name ? "itself" : "\"" + b.name + "\"") +
            " " + near_text(point) + (b.bone.empty() ? "" : ", by \"" + b.bone + "\""));
    }
    if (found.passage)
        add(std::to_string(found.passages) +
            " points of cloth passed through an avatar since the last frame, the first " +
            near_text(found.passage->point));
    if (found.penetration > limits.penetration) {
        std::snprintf(text, sizeof text, "%.3g mm deep in an avatar ", 1e3 * found.penetration);
        add(text + near_text(found.penetration_point));
    }
    if (found.area < kSmallestArea) {
        std::snprintf(text, sizeof text, "%.3g %% of the area at rest", 1e2 * found.area);
        add(text);
    }
    if (found.overstretch) {
        std::snprintf(text, sizeof text, "strain %.3g %%, with a limit of %.3g %%, ",
                      1e2 * found.overstretch->strain, 1e2 * found.overstretch->limit);
        add(text + near_text(found.overstretch->point));
    }
    return reason;
}

Json json_of(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

Json json_of(const FrameFindings::CrossingSite& site)
{
    const auto side = [](const FrameFindings::Side& of) {
        Json json{{"name", of.name}, {"triangle", of.triangle}};
        if (!of.bone.empty())
            json["bone"] = of.bone;
        return json;
    };
    return {
        {"frame", site.frame}, {"a", side(site.a)}, {"b", side(site.b)}, {"point_m", json_of(site.point)}};
}

Json json_of(const FrameFindings::PassageSite& site)
{
    return {{"frame", site.frame},
            {"cloth", site.cloth},
            {"sample", site.sample},
            {"avatar", site.avatar},
            {"point_m", json_of(site.point)}};
}

template <typename T>
Json json_or_null(const std::optional<T>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json json_of(const std::vector<Certificate::SoftBody>& soft_bodies)
{
    Json json = Json::array();
    for (const Certificate::SoftBody& body : soft_bodies)
        json.push_back(
            {{"name", body.name},
             {"inverted_tets", json_or_null(body.inverted)},
             {"inverted_tets_frame", body.inverted ? Json(body.inverted_frame) : Json(nullptr)},
             {"volume_error", json_or_null(body.volume_error)},
             {"volume_error_frame", body.volume_error ? Json(body.volume_error_frame) : Json(nullptr)}});
    return json;
}

/// Soft bodies with tetrahedra inside out, and that whose volume changes most.
std::string text_of(const std::vector<Certificate::SoftBody>& soft_bodies)
{
    std::string all;
    const Certificate::SoftBody* worst = nullptr;
    for (const Certificate::SoftBody& body : soft_bodies) {
        if (body.inverted.value_or(0) > 0)
            all += "; \"" + body.name + "\" has " + std::to_string(*body.inverted) +
                   (*body.inverted == 1 ? " tetrahedron" : " tetrahedra") + " inside out in frame " +
                   std::to_string(body.inverted_frame);
        if (body.volume_error && (worst == nullptr || *body.volume_error > *worst->volume_error))
            worst = &body;
    }
    if (worst == nullptr)
        return all;
    char text[80];
    std::snprintf(text, sizeof text, "volume off by %.3g %% at most", 1e2 * *worst->volume_error);
    return all + "; " + text + ", that of \"" + worst->name + "\" in frame " +
           std::to_string(worst->volume_error_frame);
}

} // namespace

void Certificate::add(const FrameFindings& found)
{
    const int frame = frames++;
    out_of_range += found.out_of_range;
    cloth_cloth_crossings += found.cloth_cloth_crossings;
    cloth_avatar_crossings += found.cloth_avatar_crossings;
    pinched_crossings += found.pinched_crossings;
    pinched_passages += found.pinched_passages;
    pinched_frames +=
        found.pinched_crossings > 0 || found.pinched_passages > 0 || found.pinched_depth > limits.penetration
            ? 1
            : 0;
    if (!first_pinch)
        first_pinch = found.pinch;
    if (!first_crossing)
        first_crossing = found.crossing;
    passages += found.passages;
    if (!first_passage)
        first_passage = found.passage;
    if (!first_overstretch)
        first_overstretch = found.overstretch;
    if (found.gap && (!min_gap || *found.gap < *min_gap)) {
        min_gap = found.gap;
        min_gap_frame = frame;
    }
    if (found.penetration > worst.penetration) {
        worst.penetration = found.penetration;
        worst.penetration_point = found.penetration_point;
        worst_penetration_frame = frame;
    }
    if (found.strain > worst.strain) {
        worst.strain = found.strain;
        worst.strain_point = found.strain_point;
        worst_strain_frame = frame;
    }
    if (found.attached_strain > worst.attached_strain) {
        worst.attached_strain = found.attached_strain;
        worst_attached_strain_frame = frame;
    }
    if (found.area < worst.area) {
        worst.area = found.area;
        smallest_area_frame = frame;
    }
    for (size_t i = 0; i < found.volumes.size(); ++i) {
        SoftBody& body = soft_bodies[i];
        const std::optional<double>& volume = found.volumes[i];
        if (!volume || std::abs(*volume - 1.0) <= body.volume_error.value_or(-1.0))
            continue;
        body.volume_error = std::abs(*volume - 1.0);
        body.volume_error_frame = frame;
    }
    worst.pinched_depth = std::max(worst.pinched_depth, found.pinched_depth);
    if (const std::string reason = reason_of(found, limits); !reason.empty() && first_bad_frame < 0) {
        first_bad_frame = frame;
        first_bad_reason = reason;
    }
}

void Certificate::add_inverted(int frame, const std::vector<int>& counts)
{
    for (size_t i = 0; i < counts.size(); ++i) {
        SoftBody& body = soft_bodies[i];
        if (counts[i] <= body.inverted.value_or(-1))
            continue;
        body.inverted = counts[i];
        body.inverted_frame = frame;
    }
}

std::string to_json(const Certificate& certificate)
{
    Json cloths = Json::array(), strain_limits = Json::object();
    for (const Certificate::Cloth& cloth : certificate.cloths) {
        cloths.push_back({{"name", cloth.name},
                          {"cache", cloth.cache.string()},
                          {"vertices", cloth.vertices},
                          {"faces", cloth.faces}});
        strain_limits[cloth.name] = cloth.strain_limit;
    }
    const bool has_crossing = certificate.first_crossing.has_value();
    Json json = {
        {"scene", certificate.scene.string()},
        {"solver", certificate.solver},
        {"version", version()},
        {"cloths", cloths},
        {"exports", json_of(certificate.exports)},
        {"cloths_left_out", certificate.left_out},
        {"avatar_bones_left_out", certificate.excluded_bones},
        {"holds", certificate.holds()},
        {"frames", certificate.frames},
        {"frames_expected", certificate.frames_expected},
        {"frames_left_out", certificate.frames_left_out},
        {"last_time_s",
         certificate.frames > 0 ? Json((certificate.frames - 1) / certificate.fps) : Json(nullptr)},
        {"first_bad_frame",
         certificate.first_bad_frame < 0 ? Json(nullptr) : Json(certificate.first_bad_frame)},
        {"cloth_cloth_crossings", certificate.cloth_cloth_crossings},
        {"cloth_avatar_crossings", certificate.cloth_avatar_crossings},
        {"first_crossing", has_crossing ? json_of(*certificate.first_crossing) : Json(nullptr)},
        {"passages", certificate.passages},
        {"first_passage", certificate.first_passage ? json_of(*certificate.first_passage) : Json(nullptr)},
        {"min_gap_m", json_or_null(certificate.min_gap)},
        {"min_gap_frame", certificate.min_gap ? Json(certificate.min_gap_frame) : Json(nullptr)},
        {"max_penetration_m", certificate.worst.penetration},
        {"max_penetration_frame", certificate.worst_penetration_frame},
        {"max_penetration_point_m",
         certificate.worst.penetration > 0.0 ? json_of(certificate.worst.penetration_point) : Json(nullptr)},
        {"max_strain", certificate.worst.strain},
        {"max_strain_frame", certificate.worst_strain_frame},
        {"max_strain_point_m",
         certificate.worst.strain > 0.0 ? json_of(certificate.worst.strain_point) : Json(nullptr)},
        {"max_attached_strain", certificate.worst.attached_strain},
        {"max_attached_strain_frame", certificate.worst_attached_strain_frame},
        {"min_area_ratio", certificate.worst.area},
        {"min_area_ratio_frame", certificate.smallest_area_frame},
        {"out_of_range", certificate.out_of_range},
        {"pinches",
         {{"frames", certificate.pinched_frames},
          {"crossings", certificate.pinched_crossings},
          {"passages", certificate.pinched_passages},
          {"max_penetration_m", certificate.worst.pinched_depth},
          {"first", certificate.first_pinch ? json_of(*certificate.first_pinch) : Json(nullptr)}}},
        {"limits",
         {{"penetration_m", certificate.limits.penetration},
          {"strain", strain_limits},
          {"gap_reach_m", kGapReach}}}};
    if (!certificate.soft_bodies.empty())
        json["soft_bodies"] = json_of(certificate.soft_bodies);
    // Names of files may have bytes that are not UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary_of(const Certificate& certificate)
{
    const auto is_soft_body = [&](const Certificate::Cloth& cloth) {
        return std::any_of(certificate.soft_bodies.begin(), certificate.soft_bodies.end(),
                           [&](const Certificate::SoftBody& body) { return body.name == cloth.name; });
    };
    if (!certificate.holds()) {
        std::string why;
        if (certificate.frames != certificate.frames_expected)
            why = "; " + std::to_string(certificate.frames) + " frames of the scene's " +
                  std::to_string(certificate.frames_expected);
        if (certificate.first_bad_frame >= 0)
            why += "; first bad frame " + std::to_string(certificate.first_bad_frame) + ": " +
                   certificate.first_bad_reason;
        return "the certificate does not hold" + why + text_of(certificate.soft_bodies);
    }
    char text[160];
    std::snprintf(text, sizeof text, "certificate holds for %d frames: no crossings, %.3g mm deep at most",
                  certificate.frames, 1e3 * certificate.worst.penetration);
    std::string left_out;
    if (!std::all_of(certificate.cloths.begin(), certificate.cloths.end(), is_soft_body)) {
        char strain[64];
        std::snprintf(strain, sizeof strain, ", strain %.3g %%", 1e2 * certificate.worst.strain);
        left_out = strain;
    }
    if (certificate.worst.attached_strain > certificate.worst.strain) {
        char pulled[64];
        std::snprintf(pulled, sizeof pulled, ", %.3g %% between attached vertices",
                      1e2 * certificate.worst.attached_strain);
        left_out += pulled;
    }
    if (certificate.pinched_frames > 0)
        left_out +=
            "; pinched between body parts in " + std::to_string(certificate.pinched_frames) + " frames";
    for (const auto& [avatar, bones] : certificate.excluded_bones)
        left_out += "; " + std::to_string(bones.size()) + (bones.size() == 1 ? " bone of " : " bones of ") +
                    avatar + " left out";
    return text + left_out + text_of(certificate.soft_bodies);
}

} // namespace toile::app
