#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "garment/pattern/pattern.h"
#include "scenes/format/scene.h"

/// Contents of a garment file: plain values, as written. The meaning of each key is stated once, in
/// describe_garment.h; the reader, the JSON Schema and docs/reference/garment_keys.md are made from it.
namespace toile::garment_format {

/// A file of panels.
struct PatternFile {
    std::filesystem::path file;
    std::optional<scene::LengthUnit> unit; ///< absent: what the file says
};

/// A line inside of a panel, as written.
struct LineEntry {
    std::vector<Vec2> points; ///< [m]
};

/// How a panel is cut and where it starts.
struct PanelSettings {
    std::optional<std::string> fabric; ///< name of a preset
    std::optional<double> edge;        ///< [m] of the mesh's edges
    double grain_deg = 0.0;
    scene::WarpWeft shrink; ///< [-] absent: 1
    int copies = 1;
    bool mirror = false; ///< every second copy is a mirror image
    std::optional<garment::BodyPlacement> place;
    int layer = 0;
    std::map<std::string, LineEntry> lines; ///< by name
};

/// Ends of a seam's sides that meet.
enum class SeamJoin { StartEnd, StartStart };

/// A seam as written: its sides name edges or parts of them.
struct SeamEntry {
    std::vector<std::string> a;
    std::vector<std::string> b;
    SeamJoin join = SeamJoin::StartEnd;
    double fold_deg = 0.0;
    int order = 0;
    garment::Gather gather = garment::Gather::Short;
};

/// An elastic as written.
struct ElasticEntry {
    std::vector<std::string> edges;
    double ratio = 0.8;      ///< [-]
    double stiffness = 20.0; ///< [N]
};

/// A fold as written, by `line` or `between`.
struct FoldEntry {
    std::optional<std::string> panel; ///< of the line
    std::vector<Vec2> line;           ///< [2 or more] in the panel's plane [m]
    std::vector<std::string> between; ///< [2] points of a panel's edges
    double angle_deg = 0.0;
    double stiffness = garment::kFoldStiffness; ///< [N]
};

/// A tack or button as written, by two points of panels.
struct ClosureEntry {
    std::string a;
    std::string b;
    double close_at = 0.0; ///< [s]
};

/// What is held on the body, as written.
struct AttachEntry {
    std::vector<std::string> edges;
    std::vector<std::string> points;
    bool release = false;
};

struct GarmentFile {
    std::string description;
    std::vector<PatternFile> patterns;
    std::map<std::string, PanelSettings> panels; ///< by name
    std::vector<SeamEntry> seams;
    std::vector<ElasticEntry> elastics;
    std::vector<FoldEntry> folds;
    std::vector<ClosureEntry> closures;
    std::vector<AttachEntry> attach;
};

} // namespace toile::garment_format
