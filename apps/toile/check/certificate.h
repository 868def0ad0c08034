#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Limits of accepted defects.
struct CertificateLimits {
    double penetration = 0.001;  ///< [m] depth inside an avatar
    double strain_margin = 0.05; ///< [-] strain beyond the fabric's limit
};

/// Smallest area of cloth relative to its area at rest [-]: cloth folds rather than shrinks, so a cache of
/// less belongs to another scene, or is in another unit.
inline constexpr double kSmallestArea = 0.5;

/// Findings of one frame, all cloths together. A frame with coordinates out of range has no others.
struct FrameFindings {
    /// One of two triangles that cross.
    struct Side {
        std::string name;      ///< of the cloth or avatar
        int triangle;          ///< -1: a lid over excluded faces of an avatar
        std::string bone = {}; ///< of an avatar; empty: it has none there
    };
    struct CrossingSite {
        int frame;
        Side a, b;  ///< a is of a cloth
        Vec3 point; ///< [m]
    };

    /// Sample of cloth that went through an avatar since the last frame.
    struct PassageSite {
        int frame;
        std::string cloth;
        std::string sample; ///< "vertex 12"
        std::string avatar;
        Vec3 point; ///< [m]
    };

    int torn = 0;         ///< vertices of the file that have left the one that they are joined to
    int out_of_range = 0; ///< vertices that are not is_in_range()
    int cloth_cloth_crossings = 0;
    int cloth_avatar_crossings = 0;        ///< outside of pinches (AvatarCrossings)
    int pinched_crossings = 0;             ///< in pinches
    std::optional<CrossingSite> pinch;     ///< the first of them
    std::optional<CrossingSite> crossing;  ///< first crossing that makes the frame bad
    int passages = 0;                      ///< samples of cloth that went through avatars, outside of pinches
    std::optional<PassageSite> passage;    ///< the first of them
    int pinched_passages = 0;              ///< in pinches
    std::optional<double> gap;             ///< [m] none: larger than kGapReach
    double penetration = 0.0;              ///< [m] maximum depth
    Vec3 penetration_point = Vec3::Zero(); ///< [m] of the cloth there
    double pinched_depth = 0.0;            ///< [m] maximum depth in pinches
    double strain = 0.0;                   ///< [-] maximum of all cloths
    Vec3 strain_point = Vec3::Zero();      ///< [m] middle of that triangle
    double attached_strain = 0.0;          ///< [-] of triangles with three attached vertices
    /// A triangle that exceeds the limit of its fabric.
    struct Overstretch {
        double strain = 0.0;       ///< [-]
        double limit = 0.0;        ///< [-] the margin included
        Vec3 point = Vec3::Zero(); ///< [m] its middle
    };
    std::optional<Overstretch> overstretch; ///< that with the largest excess
    double area = 1.0; ///< [-] smallest area of a cloth relative to that at rest, at most 1
    std::vector<std::optional<double>>
        volumes; ///< [soft bodies] relative to that at rest [-]; none: no cache
};

/// Maximum distance at which gaps of cloth to cloth are measured [m]: several thicknesses of thick cloth.
inline constexpr double kGapReach = 0.005;

/// Result for a whole run: the worst of all frames.
struct Certificate {
    /// An examined cloth.
    struct Cloth {
        std::string name;
        std::filesystem::path cache;
        double strain_limit; ///< [-] largest of its fabrics, the margin included
        int vertices, faces; ///< faces as in the mesh's file
    };

    /// Worst frames of a soft body. They are reported, and no defect.
    struct SoftBody {
        std::string name;
        std::optional<double> volume_error; ///< [-] largest |V / V0 - 1|; none: no cache
        int volume_error_frame = 0;
        std::optional<int> inverted; ///< largest number of tetrahedra with det F <= 0; none: not counted
        int inverted_frame = 0;
    };

    std::filesystem::path scene;
    std::vector<scene::Export> exports; ///< that the caches were written as, relative to the certificate
    std::string solver;                 ///< solver.method of the scene
    CertificateLimits limits;
    std::vector<Cloth> cloths;
    std::vector<std::string> left_out; ///< cloths of the scene whose caches were not given
    std::vector<SoftBody> soft_bodies; ///< of the scene

    /// Bones with excluded faces, by avatar; only avatars that have such bones.
    std::map<std::string, std::vector<std::string>> excluded_bones;

    int frames = 0;
    int frames_expected = 0; ///< of the scene
    double fps = 0.0;        ///< of the scene
    int frames_left_out = 0; ///< frames of the longest cache that a shorter one lacks
    int out_of_range = 0;
    long cloth_cloth_crossings = 0; ///< pairs of triangles, summed over frames, as the other count
    long cloth_avatar_crossings = 0;
    long pinched_crossings = 0;
    long pinched_passages = 0;
    int pinched_frames = 0;
    std::optional<FrameFindings::CrossingSite> first_pinch;
    std::optional<FrameFindings::CrossingSite> first_crossing;
    std::optional<FrameFindings::Overstretch> first_overstretch;
    long passages = 0;
    std::optional<FrameFindings::PassageSite> first_passage;
    std::optional<double> min_gap; ///< [m] 0 where cloth crosses cloth
    FrameFindings worst;           ///< maximum depths and strain, minimum area of any frame
    int min_gap_frame = 0;
    int worst_penetration_frame = 0;
    int worst_strain_frame = 0;
    int worst_attached_strain_frame = 0;
    int smallest_area_frame = 0;
    int first_bad_frame = -1;
    std::string first_bad_reason;

    bool holds() const { return first_bad_frame < 0 && frames == frames_expected; }

    /// Adds the findings of the next frame.
    void add(const FrameFindings& found);

    /// Adds what only a simulation can count, since caches hold surfaces.
    /// @param counts  [soft bodies] tetrahedra that are flat or inside out
    void add_inverted(int frame, const std::vector<int>& counts);
};

/// The certificate as JSON, ending with a newline. docs/reference/commands.md explains the keys.
std::string to_json(const Certificate& certificate);

/// Summary in one line: the maxima of a certificate that holds, else the first bad frame with its defects.
std::string summary_of(const Certificate& certificate);

} // namespace toile::app
