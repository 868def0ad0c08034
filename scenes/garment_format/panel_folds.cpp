#include "scenes/garment_format/panel_folds.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "garment/pattern/edge_curve.h"
#include "scenes/format/names.h"
#include "scenes/garment_format/copies.h"
#include "scenes/garment_format/edge_name.h"

namespace toile::garment_format {
namespace {

using garment::PanelFold;
using garment::Pattern;
using scene_format::as_written;
using scene_format::below;
using scene_format::Document;

int panel_of(const Document& document, const std::string& key_path, const std::string& name,
             const Pattern& pattern)
{
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    scene_format::require_known(document, key_path, "panel", name, names);
    return int(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Sets panel and points of a fold between two points of edges.
void set_between(const Document& document, const std::string& key_path,
                 const std::vector<std::string>& between, const Pattern& pattern, PanelFold& fold)
{
    if (between.size() != 2)
        document.refuse(key_path, std::to_string(between.size()) +
                                      (between.size() == 1 ? " point" : " points") +
                                      "; give the two ends of the fold");
    for (size_t i = 0; i < 2; ++i) {
        const EdgePoint end = edge_point_of(document, below(key_path, i), between[i], pattern);
        const garment::Panel& panel = pattern.panels[size_t(end.panel)];
        if (i > 0 && end.panel != fold.panel)
            document.refuse(below(key_path, i), as_written(between[i]) + " is on another panel than " +
                                                    as_written(between[0]) + "; a fold lies on one panel");
        fold.panel = end.panel;
        fold.points.push_back(garment::EdgeCurve(panel, end.edge).at(end.fraction));
    }
}

/// Sets panel and points of a fold along a line of points.
void set_line(const Document& document, const std::string& key_path, const FoldEntry& entry,
              const Pattern& pattern, PanelFold& fold)
{
    if (!entry.panel)
        document.refuse(key_path, "names no panel; add \"panel\", or write \"between\" for \"line\"");
    if (entry.line.size() < 2)
        document.refuse(below(key_path, "line"), std::to_string(entry.line.size()) +
                                                     (entry.line.size() == 1 ? " point" : " points") +
                                                     "; a fold needs two or more");
    fold.panel = panel_of(document, below(key_path, "panel"), *entry.panel, pattern);
    fold.points = entry.line;
}

PanelFold fold_of(const Document& document, const std::string& key_path, const FoldEntry& entry,
                  const Pattern& pattern)
{
    PanelFold fold;
    fold.angle_deg = entry.angle_deg;
    fold.stiffness = entry.stiffness;
    fold.name = key_path;
    if (entry.between.empty()) {
        set_line(document, key_path, entry, pattern, fold);
        return fold;
    }
    if (entry.panel || !entry.line.empty())
        document.refuse(below(key_path, entry.panel ? "panel" : "line"),
                        "is given together with \"between\", which names the panel and the ends; remove it");
    set_between(document, below(key_path, "between"), entry.between, pattern, fold);
    return fold;
}

/// Adds a fold, and its image on every copy of its panel. A mirror image is folded to the same side: its
/// outside is the image of the outside.
void add_to_copies(const PanelFold& fold, const GarmentFile& file, Pattern& pattern)
{
    pattern.folds.push_back(fold);
    const std::string& name = pattern.panels[size_t(fold.panel)].name;
    const auto settings = file.panels.find(name);
    if (settings == file.panels.end())
        return;
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    for (int k = 1; k < settings->second.copies; ++k) {
        PanelFold image = fold;
        image.panel = int(std::find(names.begin(), names.end(), name_of_copy(name, k)) - names.begin());
        if (settings->second.mirror && k % 2 == 1)
            for (Vec2& point : image.points)
                point.x() = -point.x();
        image.name += " of copy " + std::to_string(k + 1);
        pattern.folds.push_back(image);
    }
}

} // namespace

void add_folds(const Document& document, const GarmentFile& file, Pattern& pattern)
{
    for (size_t i = 0; i < file.folds.size(); ++i)
        add_to_copies(fold_of(document, below("folds", i), file.folds[i], pattern), file, pattern);
}

} // namespace toile::garment_format
