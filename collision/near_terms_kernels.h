#pragma once

/// How near terms are brought from a GPU to the host and what the host has moved back.

#include "collision/contact_kernels.h"
#include "collision/contact_terms.h"

namespace toile {

/// Flags term i where its gap is below the margin.
struct FlagNear {
    View<const ContactTerm> terms;
    View<const Vec3> x;            ///< [vertices] [m]
    double margin;                 ///< [m]
    View<unsigned char> near;      ///< [terms] out
    View<unsigned char> or_beside; ///< [terms] out, for FlagBeside
    View<unsigned char> has_all;   ///< [4 x terms] out, likewise

    TOILE_HD void operator()(int i) const
    {
        near[i] = or_beside[i] = terms[i].gap(x) < margin ? 1 : 0;
        for (int k = 0; k < 4; ++k)
            has_all[4 * i + k] = 0;
    }
};

/// Flags all terms of list k where one of them is near.
struct FlagBeside {
    ContactTouches touches;
    View<const unsigned char> near; ///< [terms]
    View<unsigned char> or_beside;  ///< [terms] set to 1
    View<unsigned char> has_all;    ///< [4 x terms] by term and vertex, set to 1

    TOILE_HD void operator()(int k) const
    {
        const int end = touches.first[k + 1];
        int e = touches.first[k];
        while (e < end && near[touches.entries[e] / 4] == 0)
            ++e;
        if (e == end)
            return;
        for (e = touches.first[k]; e < end; ++e) {
            or_beside[touches.entries[e] / 4] = 1;
            has_all[touches.entries[e]] = 1;
        }
    }
};

/// Copies the i-th listed term and what its vertices have.
struct CopyNear {
    View<const ContactTerm> terms;
    View<const unsigned char> has_all; ///< see FlagBeside
    View<const int> list;              ///< terms
    View<const int> count;             ///< [1] of the list
    View<const Vec3> x, v;             ///< [vertices] [m], [m/s]; v may be empty
    View<ContactTerm> to;              ///< [near terms] out
    View<NearVertices> x_to;           ///< [near terms] out
    View<Vec3> v_to;                   ///< [4 x near terms] out, where there are velocities

    TOILE_HD void operator()(int i) const
    {
        if (i >= count[0])
            return;
        const ContactTerm& term = terms[list[i]];
        to[i] = term;
        for (int k = 0; k < term.pair.count(); ++k) {
            x_to[i].x[k] = x[term.pair.vertex[k]];
            x_to[i].has_all[k] = has_all[4 * list[i] + k];
            if (!v.empty())
                v_to[4 * i + k] = v[term.pair.vertex[k]];
        }
    }
};

/// A vertex and where it has been put.
struct PlacedVertex {
    int vertex = 0;
    Vec3 x = Vec3::Zero(); ///< [m]
    Vec3 v = Vec3::Zero(); ///< [m/s]
};

/// Those that are named more than once have the same values each time.
struct PlaceVertex {
    View<const PlacedVertex> placed;
    View<Vec3> x, v; ///< [vertices] [m], [m/s]; v may be empty

    TOILE_HD void operator()(int i) const
    {
        x[placed[i].vertex] = placed[i].x;
        if (!v.empty())
            v[placed[i].vertex] = placed[i].v;
    }
};

} // namespace toile
