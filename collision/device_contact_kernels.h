#pragma once

#include "collision/contact_kernels.h"

namespace toile {

/// Tells vertex of list k which list is its own.
struct NumberList {
    View<const int> vertices; ///< [lists]
    View<int> list_of;        ///< [vertices] out, 0 elsewhere
    TOILE_HD void operator()(int k) const { list_of[vertices[k]] = k + 1; }
};

/// Adds the forces on the vertex of list k, and the energies of the terms whose first vertex it is.
struct AddContact {
    ContactTouches touches;
    View<const int> vertices;  ///< [lists]
    View<const Vec3> force;    ///< [terms] [N]
    View<const double> energy; ///< [terms] [J]
    View<Vec3> gradient;       ///< [vertices] added to [N]
    View<double> own;          ///< [vertices] added to: shares of the value [J]

    TOILE_HD void operator()(int k) const
    {
        const int v = vertices[k];
        gradient[v] += touches.force(k, force);
        double sum = 0.0;
        for (int e = touches.first[k]; e < touches.first[k + 1]; ++e)
            if (touches.entries[e] % 4 == 0)
                sum += energy[touches.entries[e] / 4];
        own[v] += sum;
    }
};

/// FreezeContact; a term of how many act.
struct FreezeAndCount {
    FreezeContact freeze;
    TOILE_HD int operator()(int i) const
    {
        freeze(i);
        return freeze.frozen[i].acts() ? 1 : 0;
    }
};

/// The block of list k.
struct BoundList {
    ContactTouches touches;
    View<const FrozenContact> frozen; ///< [terms]
    View<Mat3> blocks;                ///< [lists] out
    TOILE_HD void operator()(int k) const { blocks[k] = touches.block(k, frozen); }
};

/// The forces on the vertex of list k.
struct GatherList {
    ContactTouches touches;
    View<const Vec3> force; ///< [terms] [N]
    View<Vec3> product;     ///< [lists] out [N]
    TOILE_HD void operator()(int k) const { product[k] = touches.force(k, force); }
};

} // namespace toile
