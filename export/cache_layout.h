#pragma once

#include <string>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/obj.h"
#include "export/axes.h"
#include "export/mesh/face_panels.h"

namespace toile::exports {

/// A mesh of a cache.
struct CacheMesh {
    std::string name;   ///< as the user gave it; empty: that of the file
    std::string parent; ///< group that it lies in, in Alembic and USD; empty: none
    int vertex_count = 0;
    ObjMesh faces; ///< polygons, texture coordinates and groups; positions are ignored

    std::vector<std::string> attributes = {}; ///< names of numbers that each vertex has in every sample
    FacePanels panels = {};                   ///< stored as kPanelAttribute; empty: they are not
};

/// A mesh without its positions.
ObjMesh faces_only(ObjMesh mesh);

/// Properties of a cache that are fixed before its first frame.
struct CacheLayout {
    std::vector<CacheMesh> meshes; ///< one, where CacheFeatures::several is false
    int frame_count = 0;           ///< samples that the run will deliver
    double fps = 24.0;             ///< [frames/s] stored where CacheFeatures::times
    int subframes = 1;             ///< samples per frame
    double start_frame = 0.0; ///< scene frame that shows the first sample; PC2 stores it, formats with times
                              ///< shift them by it, numbered files count from it
    int resume_at = 0;        ///< samples to keep from an earlier run; writing continues with this one
    Axes axes;                ///< of the positions that are delivered; nothing is converted
    bool velocities = true;   ///< stored by formats that have them
    bool normals = false;     ///< the same
    double max_error = 0.001; ///< [m] of a vertex in any frame; .glb approximates

    int vertex_count() const;    ///< of all meshes together
    int attribute_count() const; ///< numbers of CacheSample::attributes
    bool has_attributes() const; ///< those, or panels

    double samples_per_second() const { return fps * subframes; }
    /// Time [frames] of a sample.
    double frame_of(int sample) const { return start_frame + double(sample) / subframes; }
};

/// Layout of a cache for the vertices and faces of `mesh`.
CacheLayout cache_layout(const ObjMesh& mesh, int frame_count);
CacheLayout cache_layout(const TriangleMesh& mesh, int frame_count);

} // namespace toile::exports
