#include "scenes/garment_format/panel_json.h"

#include <algorithm>
#include <numbers>

#include "scenes/format/names.h"
#include "scenes/format/reader.h"

namespace toile::garment_format {
namespace {

using scene_format::as_written;
using scene_format::below;
using scene_format::Document;
using scene_format::Json;
using scene_format::Range;
using scene_format::read_numbers;
using scene_format::read_value;
using scene_format::require_array;

/// Any number that is no mistake, in pattern units.
constexpr Range kLength{-1e7, 1e7};
constexpr Range kRadius{0.0, 1e9, "", true};
constexpr Range kRelative{-1000.0, 1000.0};
constexpr Range kUnits{0.0, 1e5, "", true};

enum class Dialect { Older, GarmentCode };

/// What holds for all panels of a file.
struct Conventions {
    double metres; ///< per unit of the pattern
    bool relative_controls;
    Dialect dialect;
};

/// Complains about keys that are nearly ones that have a meaning. Others are none of ours.
void require_no_typo(const Document& document, const Json& json, const std::string& key_path,
                     const std::vector<std::string>& keys)
{
    for (const auto& [key, member] : json.items())
        if (!scene_format::contains(keys, key))
            if (const std::string near = scene_format::did_you_mean(key, keys); !near.empty())
                document.refuse(below(key_path, key), "unknown key" + near);
}

/// Member of an object that must be there.
const Json& member(const Document& document, const Json& json, const std::string& key_path, const char* key)
{
    if (!json.is_object())
        document.refuse(key_path, as_written(json) + " is not an object; write {...}");
    if (!json.contains(key))
        document.refuse(key_path, "the key " + as_written(key) + " is missing; add it");
    return json[key];
}

/// GarmentCode writes curvature as objects and gives labels; the older program writes bare control points.
Dialect dialect_of(const Json& panels)
{
    for (const Json& panel : panels) {
        if (!panel.is_object())
            continue;
        if (panel.contains("label"))
            return Dialect::GarmentCode;
        for (const Json& edge : panel.value("edges", Json::array()))
            if (edge.is_object() &&
                (edge.contains("label") || (edge.contains("curvature") && edge["curvature"].is_object())))
                return Dialect::GarmentCode;
    }
    return Dialect::Older;
}

Conventions conventions_of(const Document& document, const Json& json, std::optional<scene::LengthUnit> unit)
{
    const std::string key_path = "properties";
    const Json properties = json.value("properties", Json::object());
    if (!properties.is_object())
        document.refuse(key_path, as_written(properties) + " is not an object; write {...}");
    require_no_typo(document, properties, key_path, {"units_in_meter", "curvature_coords"});

    Conventions conventions{1.0, true, dialect_of(json["pattern"]["panels"])};
    if (unit) {
        conventions.metres = metres_per(*unit);
    } else if (properties.contains("units_in_meter")) {
        double units = 0.0;
        read_value(document, properties["units_in_meter"], below(key_path, "units_in_meter"), units, kUnits);
        conventions.metres = 1.0 / units;
    } else {
        document.refuse(key_path, "the key \"units_in_meter\" is missing; add it: 100 for centimetres");
    }
    if (properties.contains("curvature_coords"))
        conventions.relative_controls =
            scene_format::read_word(document, properties["curvature_coords"],
                                    below(key_path, "curvature_coords"), {"relative", "absolute"}) == 0;
    return conventions;
}

// --- edges ---

/// Control point of an edge from p to q, in metres.
Vec2 read_control(const Document& document, const Json& json, const std::string& key_path,
                  const Conventions& conventions, const Vec2& p, const Vec2& q)
{
    Vec2 control;
    read_numbers(document, json, key_path, control.data(), 2,
                 conventions.relative_controls ? kRelative : kLength);
    if (!conventions.relative_controls)
        return conventions.metres * control;
    const Vec2 e = q - p;
    return p + control.x() * e + control.y() * Vec2(-e.y(), e.x());
}

bool read_flag(const Document& document, const Json& json, const std::string& key_path)
{
    if (json.is_boolean())
        return json.get<bool>();
    if (json != 0 && json != 1)
        document.refuse(key_path, as_written(json) + " is neither 0 nor 1; write one of the two");
    return json == 1;
}

/// @param params  [radius, large, right]
garment::CircularArc read_arc(const Document& document, const Json& params, const std::string& key_path,
                              const Conventions& conventions)
{
    require_array(document, params, key_path);
    if (params.size() != 3)
        document.refuse(key_path, as_written(params) + " does not describe a circle; write [radius, large, "
                                                       "right], the latter two 0 or 1");
    garment::CircularArc arc;
    read_value(document, params[0], below(key_path, size_t(0)), arc.radius, kRadius);
    arc.radius *= conventions.metres;
    arc.large = read_flag(document, params[1], below(key_path, 1));
    arc.counter_clockwise = read_flag(document, params[2], below(key_path, 2));
    return arc;
}

/// @param params  list of `count` control points
garment::Bezier read_bezier(const Document& document, const Json& params, const std::string& key_path,
                            const Conventions& conventions, size_t count, const Vec2& p, const Vec2& q)
{
    require_array(document, params, key_path);
    if (params.size() != count)
        document.refuse(key_path, as_written(params) + " is not a list of " + std::to_string(count) +
                                      (count == 1 ? " control point" : " control points") +
                                      "; write [[x, y]" + (count == 1 ? "]" : ", [x, y]]"));
    garment::Bezier bezier;
    for (size_t i = 0; i < count; ++i)
        bezier.controls.push_back(read_control(document, params[i], below(key_path, i), conventions, p, q));
    return bezier;
}

/// Reads a curvature: [x, y] of the older dialect, or an object with type and params.
std::variant<garment::Bezier, garment::CircularArc> read_curve(const Document& document, const Json& json,
                                                               const std::string& key_path,
                                                               const Conventions& conventions, const Vec2& p,
                                                               const Vec2& q)
{
    if (json.is_array())
        return garment::Bezier{{read_control(document, json, key_path, conventions, p, q)}};
    static_cast<void>(member(document, json, key_path, "type"));
    const size_t type = scene_format::read_word(document, json["type"], below(key_path, "type"),
                                                {"quadratic", "cubic", "circle"});
    const Json& params = member(document, json, key_path, "params");
    const std::string params_path = below(key_path, "params");
    if (type == 2)
        return read_arc(document, params, params_path, conventions);
    return read_bezier(document, params, params_path, conventions, type + 1, p, q);
}

void read_label(const Document& document, const Json& json, const std::string& key_path, std::string& label)
{
    if (json.contains("label"))
        read_value(document, json["label"], below(key_path, "label"), label);
}

garment::PanelEdge read_edge(const Document& document, const Json& json, const std::string& key_path,
                             const Conventions& conventions, const std::vector<Vec2>& corners)
{
    const Json& endpoints = member(document, json, key_path, "endpoints");
    require_no_typo(document, json, key_path, {"endpoints", "curvature", "label"});
    const std::string ends_path = below(key_path, "endpoints");
    if (!endpoints.is_array() || endpoints.size() != 2)
        document.refuse(ends_path,
                        as_written(endpoints) + " is not a list of 2 vertices; write [start, end]");
    const Range vertices{0.0, double(corners.size()) - 1.0};
    garment::PanelEdge edge;
    read_value(document, endpoints[0], below(ends_path, size_t(0)), edge.start, vertices);
    read_value(document, endpoints[1], below(ends_path, 1), edge.end, vertices);
    if (json.contains("curvature") && !json["curvature"].is_null())
        edge.curve = read_curve(document, json["curvature"], below(key_path, "curvature"), conventions,
                                corners[size_t(edge.start)], corners[size_t(edge.end)]);
    read_label(document, json, key_path, edge.label);
    return edge;
}

// --- panels ---

Vec3 read_triple(const Document& document, const Json& json, const std::string& key_path, const char* key,
                 const Range& range)
{
    Vec3 value = Vec3::Zero();
    if (json.contains(key))
        read_numbers(document, json[key], below(key_path, key), value.data(), 3, range);
    return value;
}

Eigen::Matrix3d rotation_of(const Vec3& degrees, Dialect dialect)
{
    const Vec3 angles = degrees * (std::numbers::pi / 180.0);
    const Eigen::AngleAxisd x(angles.x(), Vec3::UnitX());
    const Eigen::AngleAxisd y(angles.y(), Vec3::UnitY());
    const Eigen::AngleAxisd z(angles.z(), Vec3::UnitZ());
    return dialect == Dialect::GarmentCode ? (x * y * z).toRotationMatrix() : (z * y * x).toRotationMatrix();
}

garment::Panel read_panel(const Document& document, const Json& json, const std::string& name,
                          const std::string& key_path, const Conventions& conventions)
{
    const Json& vertices = member(document, json, key_path, "vertices");
    const Json& edges = member(document, json, key_path, "edges");
    require_no_typo(document, json, key_path, {"vertices", "edges", "translation", "rotation", "label"});
    require_array(document, vertices, below(key_path, "vertices"));
    require_array(document, edges, below(key_path, "edges"));

    garment::Panel panel;
    panel.name = name;
    read_label(document, json, key_path, panel.label);
    for (size_t i = 0; i < vertices.size(); ++i) {
        Vec2 corner;
        read_numbers(document, vertices[i], below(below(key_path, "vertices"), i), corner.data(), 2, kLength);
        panel.corners.push_back(conventions.metres * corner);
    }
    for (size_t i = 0; i < edges.size(); ++i)
        panel.edges.push_back(
            read_edge(document, edges[i], below(below(key_path, "edges"), i), conventions, panel.corners));
    panel.placement.translation() =
        conventions.metres * read_triple(document, json, key_path, "translation", kLength);
    panel.placement.linear() = rotation_of(
        read_triple(document, json, key_path, "rotation", scene_format::kAngle), conventions.dialect);
    return panel;
}

/// Names of the panels: those of panel_order first.
std::vector<std::string> ordered_names(const Json& pattern)
{
    std::vector<std::string> names;
    for (const Json& name : pattern.value("panel_order", Json::array()))
        if (name.is_string() && pattern["panels"].contains(name.get<std::string>()) &&
            !scene_format::contains(names, name))
            names.push_back(name);
    for (const auto& [name, panel] : pattern["panels"].items())
        if (!scene_format::contains(names, name))
            names.push_back(name);
    return names;
}

/// Names stand in messages and in groups of OBJ files, which spaces and # would end.
void require_plain_name(const Document& document, const std::string& name)
{
    const bool has_space =
        std::any_of(name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == 0x7f; });
    if (name.empty() || has_space || name.find_first_of("[#\\") != std::string::npos)
        document.refuse("pattern.panels",
                        as_written(name) + " can't name a panel; use letters, digits, _ and -");
}

// --- stitches ---

/// Whole edge named by {"panel": name, "edge": index}.
garment::EdgePart read_stitch_side(const Document& document, const Json& json, const std::string& key_path,
                                   const garment::Pattern& pattern)
{
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    std::string name;
    read_value(document, member(document, json, key_path, "panel"), below(key_path, "panel"), name);
    scene_format::require_known(document, below(key_path, "panel"), "panel", name, names);
    garment::EdgePart part;
    part.panel = int(std::find(names.begin(), names.end(), name) - names.begin());
    const double last = double(pattern.panels[size_t(part.panel)].edges.size()) - 1.0;
    const Json& edge = member(document, json, key_path, "edge");
    if (edge.is_number() && (edge.get<double>() < 0.0 || edge.get<double>() > last))
        document.refuse(below(key_path, "edge"), "panel " + as_written(name) + " has no edge " +
                                                     as_written(edge) + "; its edges are 0 to " +
                                                     std::to_string(int(last)));
    read_value(document, edge, below(key_path, "edge"), part.edge, Range{0.0, last});
    return part;
}

garment::Seam read_stitch(const Document& document, const Json& json, const std::string& key_path,
                          const garment::Pattern& pattern)
{
    require_array(document, json, key_path);
    if (json.size() != 2 && json.size() != 3)
        document.refuse(key_path, as_written(json) + " does not join two edges; write [{\"panel\": ..., "
                                                     "\"edge\": ...}, {...}]");
    garment::EdgePart a = read_stitch_side(document, json[0], below(key_path, size_t(0)), pattern);
    garment::EdgePart b = read_stitch_side(document, json[1], below(key_path, 1), pattern);
    const bool same_way = json.size() == 3;
    if (same_way && json[2] != "right_wrong")
        document.refuse(below(key_path, 2), as_written(json[2]) + " is unknown; write \"right_wrong\", or "
                                                                  "nothing");
    if (!same_way)
        std::swap(b.from, b.to);
    garment::Seam seam{{a}, {b}, key_path, {}};
    seam.flip = same_way ? "remove \"right_wrong\" from it" : "add \"right_wrong\" as its third entry";
    return seam;
}

} // namespace

garment::Pattern read_panel_json(const Document& document, const Json& json,
                                 std::optional<scene::LengthUnit> unit)
{
    const Json& description = member(document, json, "", "pattern");
    const Json& panels = member(document, description, "pattern", "panels");
    if (!panels.is_object())
        document.refuse("pattern.panels", as_written(panels) + " is not an object; write {\"name\": {...}}");
    const Conventions conventions = conventions_of(document, json, unit);

    garment::Pattern pattern;
    pattern.source = document.source().string();
    pattern.files = {document.source()};
    for (const std::string& name : ordered_names(description)) {
        require_plain_name(document, name);
        pattern.panels.push_back(
            read_panel(document, panels[name], name, below("pattern.panels", name), conventions));
    }
    const Json stitches = description.value("stitches", Json::array());
    require_array(document, stitches, "pattern.stitches");
    for (size_t i = 0; i < stitches.size(); ++i)
        pattern.seams.push_back(read_stitch(document, stitches[i], below("pattern.stitches", i), pattern));
    return pattern;
}

} // namespace toile::garment_format
