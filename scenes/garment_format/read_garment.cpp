#include "scenes/garment_format/read_garment.h"

#include "garment/pattern/check_panel.h"
#include "garment/pattern/check_pattern.h"
#include "scenes/format/reader.h"
#include "scenes/garment_format/assemble.h"
#include "scenes/garment_format/describe_garment.h"
#include "scenes/garment_format/panel_json.h"

namespace toile::garment_format {
namespace {

using garment::Pattern;
using scene_format::below;
using scene_format::Document;
using scene_format::Json;

constexpr const char* kVersionKey = "toile_garment";
constexpr const char* kKind = "garment file or panel JSON";

/// Complains about JSON that is no sewing pattern.
void require_panel_json(const Document& document, const Json& json)
{
    if (json.is_object() && json.contains("pattern"))
        return;
    if (json.is_object() && json.contains("toile"))
        document.refuse("", "is a scene; name a garment file or panel JSON");
    document.refuse("", "is neither a garment file (\"toile_garment\": 1) nor a panel JSON (\"pattern\": "
                        "{\"panels\": {...}, \"stitches\": [...]}); name one of them");
}

/// Panels of one file, which can be cut.
Pattern read_panel_file(const Document& document, const Json& json, std::optional<scene::LengthUnit> unit)
{
    require_panel_json(document, json);
    Pattern pattern = read_panel_json(document, json, unit);
    for (const garment::Panel& panel : pattern.panels)
        garment::require_cuttable(panel, pattern.source);
    return pattern;
}

/// The panel files of a garment.
std::vector<Pattern> read_parts(const Document& document, const GarmentFile& garment)
{
    if (garment.patterns.empty())
        document.refuse("patterns", "names no file; a garment needs one at least");
    std::vector<Pattern> parts;
    for (size_t i = 0; i < garment.patterns.size(); ++i) {
        const std::string key_path = below(below("patterns", i), "file");
        const std::filesystem::path file =
            document.existing_file(garment.patterns[i].file.string(), key_path);
        const Document part(file);
        const Json json = part.parse(scene_format::read_document(file, "panel JSON"));
        if (json.is_object() && json.contains(kVersionKey))
            document.refuse(key_path, scene_format::as_written(file.string()) +
                                          " is a garment file itself; name the panel JSON that it names");
        parts.push_back(read_panel_file(part, json, garment.patterns[i].unit));
    }
    return parts;
}

} // namespace

Pattern read_pattern(const std::filesystem::path& file)
{
    return parse_pattern(scene_format::read_document(file, kKind), file);
}

Pattern parse_pattern(const std::string& text, const std::filesystem::path& source)
{
    const Document document(source);
    const Json json = document.parse(text);
    Pattern pattern;
    if (json.is_object() && json.contains(kVersionKey)) {
        const auto garment = scene_format::read_described<GarmentFile>(document, json);
        pattern = assemble(document, garment, read_parts(document, garment));
    } else {
        pattern = read_panel_file(document, json, std::nullopt);
    }
    garment::require_sewable(pattern);
    return pattern;
}

} // namespace toile::garment_format
