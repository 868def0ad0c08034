#include "apps/toile/pattern/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/number.h"
#include "scenes/format/field.h"

namespace toile::app {

using garment::MeshQuality;
using garment::SewnTopology;
using Json = nlohmann::ordered_json;

namespace {

std::string counted(std::ptrdiff_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Multiple of 1 / `parts`, not rounded up: 99.96 % are not all.
double floored(double value, double parts) { return std::floor(value * parts) / parts; }

double degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

/// One digit after the point, not rounded up.
std::string decimal(double value)
{
    const long tenths = std::lround(std::floor(10.0 * value));
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

std::string size_text(const MeshQuality& quality)
{
    return counted(quality.vertices, "vertex", "vertices") + ", " +
           counted(quality.triangles, "triangle", "triangles");
}

std::string shape_text(const MeshQuality& quality)
{
    return "smallest angle " + decimal(degrees(quality.smallest_angle)) + " degrees, " +
           decimal(100.0 * quality.in_range) + " % of edges within 0.6 to 1.6 of the target";
}

std::string panel_text(const MeshReport& report, size_t panel)
{
    const double used = report.mesh.edge[panel], asked = report.targets[panel];
    std::string text = "panel " + report.pattern.pattern.panels[panel].name + ": " +
                       size_text(report.panels[panel]) + ", target " + short_text(used) + " m";
    if (used < asked)
        text += " instead of " + short_text(asked) + " m, because the panel is narrow";
    return text + ", " + shape_text(report.panels[panel]) + "\n";
}

std::string seam_text(const MeshReport& report, size_t seam)
{
    const garment::Pattern& pattern = report.pattern.pattern;
    return "seam " + std::to_string(seam) + ": " + sides_text(pattern, pattern.seams[seam]) + ", " +
           counted(std::ptrdiff_t(report.mesh.stitches[seam].size()), "pair", "pairs") + "\n";
}

std::string manifold_text(const MeshReport& report)
{
    const SewnTopology& topology = report.sewn.topology;
    if (topology.is_manifold())
        return "manifold";
    std::string text =
        "not manifold: " + counted(std::ptrdiff_t(topology.non_manifold_edges.size()), "edge", "edges") +
        " of three or more triangles, " +
        counted(std::ptrdiff_t(topology.collapsed_triangles.size() + topology.duplicate_triangles.size()),
                "collapsed or repeated triangle", "collapsed or repeated triangles");
    if (!topology.non_manifold_edges.empty()) {
        const int vertex = report.sewn.members[topology.non_manifold_edges.front()[0]].front();
        const Vec2& x = report.mesh.uv[vertex];
        text += ", the first in panel " +
                report.pattern.pattern.panels[report.mesh.panel_of_vertex(vertex)].name + " at (" +
                short_text(x.x()) + ", " + short_text(x.y()) + ") m";
    }
    return text;
}

std::string sewn_text(const MeshReport& report)
{
    const SewnTopology& topology = report.sewn.topology;
    std::string text = "sewn: " + counted(report.sewn.vertex_count, "vertex", "vertices") + ", " +
                       counted(topology.pieces, "piece", "pieces") + ", " +
                       counted(topology.border_loops, "border loop", "border loops") +
                       ", Euler characteristic " + std::to_string(topology.euler_characteristic) + ", ";
    if (const std::optional<int> seam = report.one_sided_seam())
        text += "one-sided by seam " + std::to_string(*seam);
    else
        text += "orientable";
    return text + ", " + manifold_text(report) + "\n";
}

Json json_of(const MeshQuality& quality)
{
    return {{"vertices", quality.vertices},
            {"triangles", quality.triangles},
            {"smallest_angle_deg", floored(degrees(quality.smallest_angle), 10.0)},
            {"in_range", floored(quality.in_range, 1000.0)}};
}

Json panel_json(const MeshReport& report, size_t panel)
{
    Json json = {{"name", report.pattern.pattern.panels[panel].name},
                 {"edge_m", report.mesh.edge[panel]},
                 {"asked_edge_m", report.targets[panel]}};
    json.update(json_of(report.panels[panel]));
    return json;
}

Json seam_json(const MeshReport& report, size_t seam)
{
    const SeamFacts& facts = report.pattern.seams[seam];
    Json json = {{"id", seam},
                 {"key", report.pattern.pattern.seams[seam].name},
                 {"pairs", report.mesh.stitches[seam].size()},
                 {"twisted", facts.twisted()}};
    if (facts.twisted())
        json["mend"] = facts.mend;
    return json;
}

Json sewn_json(const MeshReport& report)
{
    const SewnTopology& topology = report.sewn.topology;
    Json json = {{"vertices", report.sewn.vertex_count},
                 {"pieces", topology.pieces},
                 {"border_loops", topology.border_loops},
                 {"euler_characteristic", topology.euler_characteristic},
                 {"orientable", topology.is_orientable()},
                 {"one_sided_seam", nullptr},
                 {"non_manifold_edges", topology.non_manifold_edges.size()},
                 {"collapsed_triangles", topology.collapsed_triangles.size()},
                 {"duplicate_triangles", topology.duplicate_triangles.size()}};
    if (const std::optional<int> seam = report.one_sided_seam())
        json["one_sided_seam"] = *seam;
    return json;
}

} // namespace

std::optional<int> MeshReport::one_sided_seam() const
{
    if (sewn.topology.is_orientable())
        return std::nullopt;
    const auto seam = std::find_if(pattern.seams.begin(), pattern.seams.end(),
                                   [](const SeamFacts& facts) { return facts.one_sided; });
    return seam != pattern.seams.end() ? int(seam - pattern.seams.begin()) : sewn.topology.one_sided_seam;
}

const char* MeshReport::outcome() const
{
    if (!sewn.topology.is_orientable())
        return "seams";
    return sewn.topology.is_manifold() ? "ok" : "meshing";
}

void require_edge_option(double edge)
{
    const scene_format::Range& range = scene_format::kResolution; // as of edges in garment files
    if (!range.contains(edge))
        throw InvalidInput("--edge " + short_text(edge) + ": is out of range; give a length " +
                           to_sentence(range));
}

std::string failure_of(const MeshReport& report)
{
    const std::string start = report.pattern.pattern.source + ": class " + report.outcome() + ": ";
    if (const std::optional<int> seam = report.one_sided_seam()) {
        const garment::Seam& sides = report.pattern.pattern.seams[size_t(*seam)];
        return start + "seam " + std::to_string(*seam) + " makes the sewn surface one-sided; in " +
               sides.name + ": " + sides.flip;
    }
    if (!report.sewn.topology.is_manifold())
        return start + "the sewn surface is " + manifold_text(report) + "; give a smaller --edge";
    return {};
}

MeshReport mesh_report_on(garment::Pattern pattern, double edge)
{
    MeshReport report;
    for (const garment::Panel& panel : pattern.panels)
        report.targets.push_back(panel.edge_length.value_or(edge));
    report.mesh = mesh_pattern(pattern, {edge, report.targets, {}});
    report.quality = quality_of(report.mesh);
    for (int p = 0; p < report.mesh.panel_count(); ++p)
        report.panels.push_back(quality_of_panel(report.mesh, p));
    report.sewn = sewn_mesh(report.mesh);
    report.pattern = report_on(std::move(pattern));
    return report;
}

std::string to_text(const MeshReport& report)
{
    std::string text = report.pattern.pattern.source + ": " +
                       counted(report.mesh.panel_count(), "panel", "panels") + ", " +
                       size_text(report.quality) + ", " + shape_text(report.quality) + "\n";
    for (size_t p = 0; p < report.panels.size(); ++p)
        text += panel_text(report, p);
    for (size_t s = 0; s < report.pattern.seams.size(); ++s)
        text += seam_text(report, s);
    text += sewn_text(report);
    for (size_t s = 0; s < report.pattern.seams.size(); ++s)
        if (report.pattern.seams[s].twisted())
            text += twist_text(report.pattern, int(s)) + "\n";
    return text + "class: " + report.outcome() + "\n";
}

std::string to_json(const MeshReport& report)
{
    Json json = {{"file", report.pattern.pattern.source}, {"class", report.outcome()}};
    json.update(json_of(report.quality));
    json["panels"] = Json::array();
    for (size_t p = 0; p < report.panels.size(); ++p)
        json["panels"].push_back(panel_json(report, p));
    json["seams"] = Json::array();
    for (size_t s = 0; s < report.pattern.seams.size(); ++s)
        json["seams"].push_back(seam_json(report, s));
    json["sewn"] = sewn_json(report);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace toile::app
