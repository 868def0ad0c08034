#pragma once

#include <array>
#include <string>
#include <vector>

#include "avatars/model/lid_kernels.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Surface of a body for contact without some of its faces. Each hole left by them is closed with a flat lid,
/// so that a solid remains a solid with an inside.
///
///        ___________              ________
///     __/ arm  hand \     ->   __/ arm   |  lid: a fan around the mean of the hole's border
///       \___________/            \_______|
///
/// Borders of the original body stay open.
class ContactSurface {
public:
    /// @param triangles     [triangles x 3] of the whole body
    /// @param excluded      [triangles] 1 for excluded faces
    /// @param vertex_count  of the whole body
    /// @param user          named in errors
    /// @throws InvalidInput if no face is left
    ContactSurface(View<const Triangle> triangles, View<const unsigned char> excluded, int vertex_count,
                   const std::string& user);

    /// Remaining faces in their order, then the faces of the lids. Vertices are those of the whole body, then
    /// the centres of the lids.
    const std::vector<Triangle>& triangles() const { return triangles_; }
    int vertex_count() const { return body_vertices_ + lids().count(); }

    LidRims lids() const { return {first_rim_, rims_}; }

    /// Computes the centres of the lids: one call of stage "avatars/lids".
    /// @param x  [vertex_count()] body vertices, in; centres, out [m]
    void place_lids(View<Vec3> x) const;

    /// Face of the whole body for a face of triangles(), -1 for one of a lid.
    int face_of(int triangle) const { return triangle < int(face_.size()) ? face_[size_t(triangle)] : -1; }

private:
    using Edge = std::array<int, 2>;

    void close_holes(const std::vector<Edge>& border);

    int body_vertices_;
    std::vector<Triangle> triangles_;
    std::vector<int> face_;             ///< [remaining faces]
    std::vector<int> first_rim_, rims_; ///< [lids + 1], [first_rim_.back()] see LidRims
};

} // namespace toile::avatars
