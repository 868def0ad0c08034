#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/backend/types.h"

namespace toile {

/// What is let pass.
struct CertificateLimits {
    double penetration = 0.001;  ///< [m] depth inside an avatar
    double strain_margin = 0.05; ///< [-] strain beyond the fabric's limit
};

/// What was found in one frame, all cloths together.
struct FrameFindings {
    /// One of two triangles that cross.
    struct Side {
        std::string name; ///< of the cloth or avatar
        int triangle;     ///< -1: a lid over faces of an avatar that are left out
    };
    struct Place {
        int frame;
        Side a, b;  ///< a is of a cloth
        Vec3 point; ///< [m]
    };

    int non_finite = 0; ///< vertices
    int cloth_cloth_crossings = 0;
    int cloth_avatar_crossings = 0;          ///< where the avatar is clean
    int crossings_in_self_intersections = 0; ///< where it is not
    std::optional<Place> crossing;           ///< the first of those that make the frame bad
    std::optional<double> gap;               ///< [m] nothing: farther than kGapReach
    double penetration = 0.0;                ///< [m]
    double excluded = 0.0;                   ///< [m] depth where an avatar intersects itself
    double strain = 0.0;                     ///< [-] largest of all cloths
    bool is_overstretched = false;           ///< a cloth passed its own limit
};

/// How near cloth must come to cloth to be measured [m]: several thicknesses of thick cloth.
inline constexpr double kGapReach = 0.005;

/// What holds of a whole run: the worst of all frames.
struct Certificate {
    /// A cloth that was examined.
    struct Cloth {
        std::string name;
        std::filesystem::path cache;
        double strain_limit; ///< [-] of the fabric, the margin included
    };

    std::filesystem::path scene;
    std::string solver; ///< solver.method of the scene
    CertificateLimits limits;
    std::vector<Cloth> cloths;
    std::vector<std::string> left_out; ///< cloths of the scene whose caches were not given

    /// By avatar: the bones whose faces nothing was measured against. Only avatars that have such bones.
    std::map<std::string, std::vector<std::string>> excluded_bones;

    int frames = 0;
    int frames_left_out = 0; ///< of the longest cache, because a shorter one has none
    int non_finite = 0;
    long cloth_cloth_crossings = 0; ///< pairs of triangles, summed over frames; the other counts too
    long cloth_avatar_crossings = 0;
    long crossings_in_self_intersections = 0;
    std::optional<FrameFindings::Place> first_crossing;
    std::optional<double> min_gap; ///< [m] 0 where cloth crosses cloth
    FrameFindings worst;           ///< penetration, excluded and strain of any frame
    int min_gap_frame = 0;
    int worst_penetration_frame = 0;
    int worst_strain_frame = 0;
    int first_bad_frame = -1;
    std::string first_bad_reason;

    bool holds() const { return first_bad_frame < 0; }

    /// Takes in the findings of the next frame.
    void add(const FrameFindings& found);
};

/// The certificate as JSON, ending with a newline. docs/apps/README.md explains the keys.
std::string to_json(const Certificate& certificate);

/// One line: that it holds and how well, or the first bad frame and why.
std::string summary_of(const Certificate& certificate);

} // namespace toile
