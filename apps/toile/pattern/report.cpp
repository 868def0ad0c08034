#include "apps/toile/pattern/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/file_plan.h"
#include "core/base/number.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/sewn_sides.h"

namespace toile::app {

using garment::EdgePart;
using garment::Panel;
using garment::Pattern;
using garment::Seam;
using Json = nlohmann::ordered_json;

namespace {

const char* curve_of(const garment::PanelEdge& edge)
{
    if (std::holds_alternative<garment::CircularArc>(edge.curve))
        return "circle";
    static constexpr const char* kNames[] = {"straight", "quadratic", "cubic"};
    const size_t controls = std::get<garment::Bezier>(edge.curve).controls.size();
    return controls < std::size(kNames) ? kNames[controls] : "bezier";
}

PanelFacts facts_of(const Panel& panel)
{
    PanelFacts facts;
    facts.area = std::abs(signed_area(panel));
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const garment::EdgeCurve curve(panel, int(e));
        const int samples = is_straight(panel.edges[e]) ? 1 : 64;
        for (int i = 0; i <= samples; ++i)
            facts.box.extend(curve.at(double(i) / samples));
        facts.edges.push_back({curve.length(), curve_of(panel.edges[e]), panel.edges[e].label, {}});
    }
    return facts;
}

/// A seam in the words of a garment file.
struct SeamWords {
    std::vector<std::string> a;
    std::vector<std::string> b;
    const char* join = "start-start";
};

SeamWords words_of(const Pattern& pattern, const Seam& seam)
{
    SeamWords words;
    std::vector<EdgePart> b = seam.b;
    if (std::all_of(b.begin(), b.end(), [](const EdgePart& part) { return part.from > part.to; })) {
        words.join = "start-end";
        std::reverse(b.begin(), b.end());
        for (EdgePart& part : b)
            std::swap(part.from, part.to);
    }
    for (const EdgePart& part : seam.a)
        words.a.push_back(name_in_garment_file(pattern, part));
    for (const EdgePart& part : b)
        words.b.push_back(name_in_garment_file(pattern, part));
    return words;
}

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : " + ") + word;
    return text;
}

template <typename... Values>
std::string formatted(const char* format, Values... values)
{
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// Numbers as files have them: a micrometre, a square millimetre or a millionth is their last digit.
double rounded(double value) { return std::round(value * 1e6) / 1e6; }

std::string edge_text(int index, const EdgeFacts& edge)
{
    std::string text = formatted("  edge %d: %.4f m, %s", index, edge.length, edge.curve);
    if (!edge.label.empty())
        text += ", " + edge.label;
    for (const int seam : edge.seams)
        text += ", seam " + std::to_string(seam);
    return text + "\n";
}

std::string panel_text(const Panel& panel, const PanelFacts& facts)
{
    std::string text = "panel " + panel.name + (panel.label.empty() ? "" : " (" + panel.label + ")");
    text += formatted(": %.4f m^2, %.3f x %.3f m", facts.area, facts.box.sizes().x(), facts.box.sizes().y());
    if (!panel.fabric.empty())
        text += ", " + panel.fabric;
    text += "\n";
    for (size_t e = 0; e < facts.edges.size(); ++e)
        text += edge_text(int(e), facts.edges[e]);
    return text;
}

std::string seam_text(const PatternReport& report, int index)
{
    const SeamFacts& facts = report.seams[size_t(index)];
    const Seam& seam = report.pattern.seams[size_t(index)];
    return "seam " + std::to_string(index) + ": " + sides_text(report.pattern, seam) +
           formatted(", %s, %.4f and %.4f m, ratio %.3f, gap %.3f m\n", words_of(report.pattern, seam).join,
                     facts.measure.length_a, facts.measure.length_b, facts.measure.ratio(),
                     facts.measure.gap);
}

Json json_of(const EdgeFacts& edge, int index)
{
    Json json = {{"id", index}, {"length_m", rounded(edge.length)}, {"curve", edge.curve}};
    if (!edge.label.empty())
        json["label"] = edge.label;
    json["seams"] = edge.seams;
    return json;
}

Json json_of(const Panel& panel, const PanelFacts& facts)
{
    Json json = {{"name", panel.name}, {"area_m2", rounded(facts.area)}};
    json["size_m"] = {rounded(facts.box.sizes().x()), rounded(facts.box.sizes().y())};
    if (!panel.label.empty())
        json["label"] = panel.label;
    if (!panel.fabric.empty())
        json["fabric"] = panel.fabric;
    if (panel.edge_length)
        json["edge_m"] = *panel.edge_length;
    json["grain_deg"] = panel.grain_deg;
    json["layer"] = panel.layer;
    for (size_t e = 0; e < facts.edges.size(); ++e)
        json["edges"].push_back(json_of(facts.edges[e], int(e)));
    return json;
}

Json seam_json(const PatternReport& report, int index)
{
    const Seam& seam = report.pattern.seams[size_t(index)];
    const SeamFacts& facts = report.seams[size_t(index)];
    const SeamWords words = words_of(report.pattern, seam);
    Json json = {{"id", index},
                 {"key", seam.name},
                 {"a", words.a},
                 {"b", words.b},
                 {"join", words.join},
                 {"length_a_m", rounded(facts.measure.length_a)},
                 {"length_b_m", rounded(facts.measure.length_b)},
                 {"ratio", rounded(facts.measure.ratio())},
                 {"gap_m", rounded(facts.measure.gap)},
                 {"other_gap_m", rounded(facts.measure.other_gap)},
                 {"twisted", facts.twisted()},
                 {"one_sided", facts.one_sided}};
    if (facts.twisted())
        json["mend"] = facts.mend;
    return json;
}

} // namespace

double PatternReport::area() const
{
    double sum = 0.0;
    for (const PanelFacts& panel : panels)
        sum += panel.area;
    return sum;
}

PatternReport report_on(Pattern pattern)
{
    PatternReport report;
    for (const Panel& panel : pattern.panels)
        report.panels.push_back(facts_of(panel));
    const std::vector<int> one_sided = sewn_sides(pattern).one_sided;
    for (size_t s = 0; s < pattern.seams.size(); ++s) {
        const Seam& seam = pattern.seams[s];
        SeamFacts facts{measure_seam(pattern, seam), false, {}};
        facts.one_sided = std::find(one_sided.begin(), one_sided.end(), int(s)) != one_sided.end();
        if (facts.measure.crossed || facts.one_sided)
            facts.mend = seam.name + ": " + seam.flip;
        report.seams.push_back(facts);
        for (const std::vector<EdgePart>* side : {&seam.a, &seam.b})
            for (const EdgePart& part : *side)
                if (!is_on_line(pattern, part))
                    report.panels[size_t(part.panel)].edges[size_t(part.edge)].seams.push_back(int(s));
    }
    report.pattern = std::move(pattern);
    return report;
}

std::string sides_text(const Pattern& pattern, const Seam& seam)
{
    const SeamWords words = words_of(pattern, seam);
    return joined(words.a) + " to " + joined(words.b);
}

std::string name_in_garment_file(const Pattern& pattern, const EdgePart& part)
{
    const Panel& panel = pattern.panels[size_t(part.panel)];
    const garment::PanelLine* line = line_of(panel, part.edge);
    std::string name = panel.name + "." + (line ? line->name : std::to_string(part.edge));
    if (part.from != 0.0 || part.to != 1.0)
        name.append("[").append(short_text(part.from)).append(":").append(short_text(part.to)).append("]");
    return name;
}

std::string twist_text(const PatternReport& report, int seam)
{
    const SeamFacts& facts = report.seams[size_t(seam)];
    std::string why;
    if (facts.measure.crossed)
        why = formatted("its sides run against each other as they are placed, %.3f m apart in the mean, "
                        "%.3f m if the other ends are joined",
                        facts.measure.gap, facts.measure.other_gap);
    if (facts.one_sided)
        why += (why.empty() ? "" : "; ") + std::string("it makes the sewn surface one-sided");
    return "seam " + std::to_string(seam) + " is twisted: " + why + "; in " + facts.mend;
}

std::string to_text(const PatternReport& report)
{
    std::string text = report.pattern.source + ": " + std::to_string(report.panels.size()) + " panels, " +
                       formatted("%.4f m^2, ", report.area()) + std::to_string(report.seams.size()) +
                       " seams\n";
    if (!report.pattern.description.empty())
        text += report.pattern.description + "\n";
    for (size_t p = 0; p < report.panels.size(); ++p)
        text += panel_text(report.pattern.panels[p], report.panels[p]);
    for (size_t s = 0; s < report.seams.size(); ++s)
        text += seam_text(report, int(s));
    for (size_t s = 0; s < report.seams.size(); ++s)
        if (report.seams[s].twisted())
            text += twist_text(report, int(s)) + "\n";
    return text;
}

std::string to_json(const PatternReport& report)
{
    Json json = {{"file", report.pattern.source}};
    if (!report.pattern.description.empty())
        json["description"] = report.pattern.description;
    json["area_m2"] = rounded(report.area());
    json["panels"] = Json::array();
    for (size_t p = 0; p < report.panels.size(); ++p)
        json["panels"].push_back(json_of(report.pattern.panels[p], report.panels[p]));
    json["seams"] = Json::array();
    for (size_t s = 0; s < report.seams.size(); ++s)
        json["seams"].push_back(seam_json(report, int(s)));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void require_safe_output(const std::filesystem::path& file, const std::string& role,
                         const garment::Pattern& pattern)
{
    FilePlan plan;
    for (const std::filesystem::path& input : pattern.files)
        plan.add_input(input, "the pattern");
    plan.add_output(file, role);
    require_writable(file);
}

} // namespace toile::app
