#include "scenes/garment_format/assemble.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "garment/fabric/fabric.h"
#include "garment/pattern/edge_curve.h"
#include "scenes/format/names.h"
#include "scenes/garment_format/closures.h"
#include "scenes/garment_format/copies.h"
#include "scenes/garment_format/edge_name.h"
#include "scenes/garment_format/panel_folds.h"
#include "scenes/garment_format/panel_point.h"

namespace toile::garment_format {
namespace {

using garment::EdgePart;
using garment::Pattern;
using garment::Seam;
using scene_format::as_written;
using scene_format::below;
using scene_format::Document;

/// Adds panels and seams of one file to those of the others.
void merge(const Document& document, const std::string& key_path, const Pattern& part, bool is_only,
           Pattern& pattern)
{
    const std::vector<std::string> taken = scene_format::names_of(pattern.panels);
    const auto offset = int(pattern.panels.size());
    for (const garment::Panel& panel : part.panels) {
        if (scene_format::contains(taken, panel.name))
            document.refuse(key_path, "its panel " + as_written(panel.name) +
                                          " has the name of one in an earlier file; rename one of them");
        pattern.panels.push_back(panel);
    }
    for (Seam seam : part.seams) {
        for (std::vector<EdgePart>* side : {&seam.a, &seam.b})
            for (EdgePart& edge : *side)
                edge.panel += offset;
        if (!is_only)
            seam.name.append(" of ").append(std::filesystem::path(part.source).filename().string());
        pattern.seams.push_back(std::move(seam));
    }
    pattern.files.insert(pattern.files.end(), part.files.begin(), part.files.end());
}

// --- panels ---

/// Cuts of the panels as their files give them.
std::vector<Cut> cuts_of(const Document& document, const GarmentFile& file, const Pattern& pattern)
{
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    std::vector<Cut> cuts;
    for (const std::string& name : names) {
        const auto settings = file.panels.find(name);
        cuts.push_back(settings == file.panels.end() ? Cut{}
                                                     : Cut{settings->second.copies, settings->second.mirror});
        for (int k = 1; k < cuts.back().copies; ++k)
            if (scene_format::contains(names, name_of_copy(name, k)))
                document.refuse(below(below("panels", name), "copies"),
                                "the copy " + as_written(name_of_copy(name, k)) +
                                    " has the name of another panel; rename one of them");
    }
    for (const auto& [name, settings] : file.panels)
        if (settings.mirror && settings.copies < 2)
            document.refuse(below(below("panels", name), "mirror"),
                            "has no effect on a panel that is cut once; write \"copies\": 2");
    return cuts;
}

void require_preset(const Document& document, const std::string& key_path, const std::string& fabric)
{
    std::vector<std::string> names;
    for (const garment::Fabric& preset : garment::fabric_presets())
        names.push_back(preset.name);
    scene_format::require_known(document, key_path, "fabric", fabric, names);
}

void set_panel(const PanelSettings& settings, garment::Panel& panel)
{
    panel.fabric = settings.fabric.value_or("");
    panel.edge_length = settings.edge;
    panel.grain_deg = settings.grain_deg;
    panel.shrink_warp = settings.shrink.warp.value_or(1.0);
    panel.shrink_weft = settings.shrink.weft.value_or(1.0);
    panel.place = settings.place;
    panel.layer = settings.layer;
    panel.lines.clear();
    for (const auto& [name, line] : settings.lines)
        panel.lines.push_back({name, line.points});
}

/// Settings of panels from `first` on.
void set_panels(const GarmentFile& file, size_t first, Pattern& pattern)
{
    for (size_t i = first; i < pattern.panels.size(); ++i)
        if (const auto settings = file.panels.find(pattern.panels[i].name); settings != file.panels.end())
            set_panel(settings->second, pattern.panels[i]);
}

/// Names of lines are told apart from those of edges. Whether lines lie in their panels is left to the
/// mesher.
void check_lines(const Document& document, const std::string& key_path, const PanelSettings& settings,
                 const garment::Panel& panel)
{
    for (const auto& [name, line] : settings.lines) {
        const auto has_name = [&label = name](const garment::PanelEdge& edge) { return edge.label == label; };
        if (whole_number_in(name) || std::any_of(panel.edges.begin(), panel.edges.end(), has_name))
            document.refuse(below(key_path, name),
                            "is the name of an edge of " + as_written(panel.name) + "; choose another");
        if (name.empty() || name.find_first_of(".[") != std::string::npos)
            document.refuse(below(key_path, name), "can't be named in seams; choose letters and digits");
        if (line.points.size() < 2)
            document.refuse(below(below(key_path, name), "points"),
                            std::to_string(line.points.size()) +
                                (line.points.size() == 1 ? " point" : " points") +
                                "; a line needs two or more");
    }
}

/// @param original_count  panels of the files; the others are copies
void check_settings(const Document& document, const GarmentFile& file, size_t original_count,
                    const Pattern& pattern)
{
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    for (const auto& [name, settings] : file.panels) {
        const std::string key_path = below("panels", name);
        scene_format::require_known(document, key_path, "panel", name, names);
        check_lines(document, below(key_path, "lines"), settings,
                    pattern.panels[size_t(std::find(names.begin(), names.end(), name) - names.begin())]);
        if (settings.fabric)
            require_preset(document, below(key_path, "fabric"), *settings.fabric);
        const auto index = size_t(std::find(names.begin(), names.end(), name) - names.begin());
        if (index >= original_count && settings.copies > 1)
            document.refuse(below(key_path, "copies"),
                            as_written(name) + " is a copy; give the number of copies with its original");
    }
}

// --- seams ---

std::vector<EdgePart> chain_of(const Document& document, const std::string& key_path,
                               const std::vector<std::string>& names, const Pattern& pattern)
{
    if (names.empty())
        document.refuse(key_path, "names no edge; write [\"PANEL.EDGE\"]");
    std::vector<EdgePart> chain;
    for (size_t i = 0; i < names.size(); ++i)
        chain.push_back(edge_part_of(document, below(key_path, i), names[i], pattern));
    return chain;
}

std::vector<EdgePart> reversed(std::vector<EdgePart> chain)
{
    std::reverse(chain.begin(), chain.end());
    for (EdgePart& part : chain)
        std::swap(part.from, part.to);
    return chain;
}

Seam seam_of(const Document& document, const std::string& key_path, const SeamEntry& entry,
             const Pattern& pattern)
{
    Seam seam;
    seam.a = chain_of(document, below(key_path, "a"), entry.a, pattern);
    seam.b = chain_of(document, below(key_path, "b"), entry.b, pattern);
    const bool starts_meet = entry.join == SeamJoin::StartStart;
    if (!starts_meet)
        seam.b = reversed(std::move(seam.b));
    seam.name = key_path;
    seam.flip = starts_meet ? "write \"join\": \"start-end\" in it" : "write \"join\": \"start-start\" in it";
    seam.fold_deg = entry.fold_deg;
    seam.order = entry.order;
    for (const std::vector<EdgePart>* side : {&seam.a, &seam.b})
        for (const EdgePart& part : *side)
            if (entry.fold_deg != 0.0 && is_on_line(pattern, part))
                document.refuse(below(key_path, "fold_deg"),
                                "has no effect on a seam on a line inside of a panel; remove it");
    seam.gather = entry.gather;
    return seam;
}

bool is_whole(const EdgePart& part)
{
    return std::min(part.from, part.to) == 0.0 && std::max(part.from, part.to) == 1.0;
}

bool are_one_edge(const EdgePart& a, const EdgePart& b) { return a.panel == b.panel && a.edge == b.edge; }

/// Whether both seams join the same two whole edges.
bool replaces(const Seam& seam, const Seam& stitch)
{
    for (const Seam* one : {&seam, &stitch})
        if (one->a.size() != 1 || one->b.size() != 1 || !is_whole(one->a[0]) || !is_whole(one->b[0]))
            return false;
    return (are_one_edge(seam.a[0], stitch.a[0]) && are_one_edge(seam.b[0], stitch.b[0])) ||
           (are_one_edge(seam.a[0], stitch.b[0]) && are_one_edge(seam.b[0], stitch.a[0]));
}

void add_seams(const Document& document, const GarmentFile& file, Pattern& pattern)
{
    std::vector<Seam> added;
    for (size_t i = 0; i < file.seams.size(); ++i) {
        added.push_back(seam_of(document, below("seams", i), file.seams[i], pattern));
        std::erase_if(pattern.seams, [&](const Seam& stitch) { return replaces(added.back(), stitch); });
    }
    pattern.seams.insert(pattern.seams.end(), added.begin(), added.end());
}

void add_elastics(const Document& document, const GarmentFile& file, Pattern& pattern)
{
    for (size_t i = 0; i < file.elastics.size(); ++i) {
        const ElasticEntry& entry = file.elastics[i];
        pattern.elastics.push_back(
            {chain_of(document, below(below("elastics", i), "edges"), entry.edges, pattern), entry.ratio,
             entry.stiffness});
    }
}

void add_attachments(const Document& document, const GarmentFile& file, Pattern& pattern)
{
    for (size_t i = 0; i < file.attach.size(); ++i) {
        const AttachEntry& entry = file.attach[i];
        const std::string key_path = below("attach", i);
        garment::BodyAttachment attachment;
        if (entry.edges.empty() && entry.points.empty())
            document.refuse(key_path, "holds nothing; name \"edges\" or \"points\"");
        if (!entry.edges.empty())
            attachment.edges = chain_of(document, below(key_path, "edges"), entry.edges, pattern);
        for (size_t k = 0; k < entry.points.size(); ++k)
            attachment.points.push_back(
                panel_point_of(document, below(below(key_path, "points"), k), entry.points[k], pattern));
        attachment.is_released = entry.release;
        pattern.attachments.push_back(std::move(attachment));
    }
}

} // namespace

Pattern assemble(const Document& document, const GarmentFile& file, const std::vector<Pattern>& parts)
{
    Pattern pattern;
    pattern.source = document.source().string();
    pattern.description = file.description;
    pattern.files = {document.source()};
    for (size_t i = 0; i < parts.size(); ++i)
        merge(document, below(below("patterns", i), "file"), parts[i], parts.size() == 1, pattern);

    const size_t original_count = pattern.panels.size();
    const std::vector<Cut> cuts = cuts_of(document, file, pattern);
    set_panels(file, 0, pattern);
    add_copies(pattern, cuts); // with the settings of their originals
    check_settings(document, file, original_count, pattern);
    set_panels(file, original_count, pattern);
    add_seams(document, file, pattern);
    add_elastics(document, file, pattern);
    add_folds(document, file, pattern);
    add_closures(document, file, pattern);
    add_attachments(document, file, pattern);
    return pattern;
}

} // namespace toile::garment_format
