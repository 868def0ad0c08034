#include "scenes/garment_format/edge_name.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "scenes/format/names.h"

namespace toile::garment_format {
namespace {

using scene_format::as_written;
using scene_format::Document;

/// A name taken apart.
struct EdgeName {
    std::string panel;
    std::string edge;
    std::string bracket; ///< "[0.2:0.6]" or empty
};

constexpr const char* kFormOfPart =
    " names no edge; write PANEL.EDGE, with an index or a label, or PANEL.EDGE[0.2:0.6]";
constexpr const char* kFormOfPoint = " names no point of an edge; write PANEL.EDGE[0.25], with an index or a "
                                     "label and a fraction of its length";

/// @param bracket  "[0.2:0.6]"
void read_range(const Document& document, const std::string& key_path, const std::string& name,
                const std::string& bracket, garment::EdgePart& part)
{
    const size_t colon = bracket.find(':');
    if (bracket.back() != ']' || colon == std::string::npos)
        document.refuse(key_path, as_written(name) + kFormOfPart);
    const std::optional<double> from = number_in(bracket.substr(1, colon - 1));
    const std::optional<double> to = number_in(bracket.substr(colon + 1, bracket.size() - colon - 2));
    if (!from || !to)
        document.refuse(key_path, as_written(name) + kFormOfPart);
    if (std::min(*from, *to) < 0.0 || std::max(*from, *to) > 1.0 || *from == *to)
        document.refuse(key_path, as_written(name) +
                                      " is no part of an edge; give two different fractions of "
                                      "its length, from 0 to 1");
    part.from = *from;
    part.to = *to;
}

/// @param bracket  "[0.25]" or empty
double fraction_in(const Document& document, const std::string& key_path, const std::string& name,
                   const std::string& bracket)
{
    std::optional<double> fraction;
    if (bracket.size() > 2 && bracket.back() == ']')
        fraction = number_in(bracket.substr(1, bracket.size() - 2));
    if (!fraction)
        document.refuse(key_path, as_written(name) + kFormOfPoint);
    if (!(*fraction >= 0.0 && *fraction <= 1.0))
        document.refuse(key_path, as_written(name) + " lies beyond its edge; give a fraction from 0 to 1");
    return *fraction;
}

/// @param form  of names, for messages
EdgeName parse(const Document& document, const std::string& key_path, const std::string& name,
               const char* form)
{
    const size_t bracket = name.find('[');
    const std::string edge = name.substr(0, bracket);
    const size_t dot = edge.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == edge.size())
        document.refuse(key_path, as_written(name) + form);
    return {edge.substr(0, dot), edge.substr(dot + 1),
            bracket == std::string::npos ? "" : name.substr(bracket)};
}

/// Index of the edge with a label, or of the line with a name.
int labelled_edge(const Document& document, const std::string& key_path, const EdgeName& name,
                  const garment::Panel& panel)
{
    std::vector<std::string> indices;
    std::vector<std::string> labels;
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        if (panel.edges[e].label == name.edge)
            indices.push_back(std::to_string(e));
        if (!panel.edges[e].label.empty())
            labels.push_back(panel.edges[e].label);
    }
    for (size_t l = 0; l < panel.lines.size(); ++l) {
        if (panel.lines[l].name == name.edge)
            return int(panel.edges.size() + l);
        labels.push_back(panel.lines[l].name);
    }
    if (indices.size() > 1)
        document.refuse(key_path, as_written(name.edge) + " is the label of edges " +
                                      scene_format::enumerate(indices, "and") + " of panel " +
                                      as_written(name.panel) + "; name one by its index");
    if (indices.empty()) {
        const std::string near = scene_format::did_you_mean(name.edge, labels);
        document.refuse(
            key_path,
            "panel " + as_written(name.panel) + " has no edge " + as_written(name.edge) +
                (near.empty() ? "; its edges are 0 to " + std::to_string(panel.edges.size() - 1) : near));
    }
    return std::stoi(indices[0]);
}

int edge_of(const Document& document, const std::string& key_path, const EdgeName& name,
            const garment::Panel& panel)
{
    const std::optional<std::int64_t> index = whole_number_in(name.edge);
    if (!index)
        return labelled_edge(document, key_path, name, panel);
    if (*index < 0 || *index >= std::int64_t(panel.edges.size()))
        document.refuse(key_path, "panel " + as_written(name.panel) + " has no edge " + name.edge +
                                      "; its edges are 0 to " + std::to_string(panel.edges.size() - 1));
    return int(*index);
}

int panel_of(const Document& document, const std::string& key_path, const EdgeName& name,
             const garment::Pattern& pattern)
{
    const std::vector<std::string> panels = scene_format::names_of(pattern.panels);
    scene_format::require_known(document, key_path, "panel", name.panel, panels);
    return int(std::find(panels.begin(), panels.end(), name.panel) - panels.begin());
}

} // namespace

garment::EdgePart edge_part_of(const Document& document, const std::string& key_path, const std::string& name,
                               const garment::Pattern& pattern)
{
    const EdgeName parts = parse(document, key_path, name, kFormOfPart);
    garment::EdgePart part;
    if (!parts.bracket.empty())
        read_range(document, key_path, name, parts.bracket, part);
    part.panel = panel_of(document, key_path, parts, pattern);
    part.edge = edge_of(document, key_path, parts, pattern.panels[size_t(part.panel)]);
    return part;
}

EdgePoint edge_point_of(const Document& document, const std::string& key_path, const std::string& name,
                        const garment::Pattern& pattern)
{
    const EdgeName parts = parse(document, key_path, name, kFormOfPoint);
    EdgePoint point;
    point.fraction = fraction_in(document, key_path, name, parts.bracket);
    point.panel = panel_of(document, key_path, parts, pattern);
    point.edge = edge_of(document, key_path, parts, pattern.panels[size_t(point.panel)]);
    return point;
}

} // namespace toile::garment_format
