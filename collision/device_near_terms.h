#pragma once

#include <vector>

#include "collision/contact_terms.h"
#include "collision/near_terms_kernels.h"
#include "core/backend/cuda/scan.h"

namespace toile {

/// Near terms of a GPU, brought to the host with what their vertices have, and taken back: nothing of other
/// vertices is copied.
class DeviceNearTerms {
public:
    /// @param space  borrowed
    DeviceNearTerms(const CudaSpace& space, int vertex_count);

    /// The terms with a gap below the margin [m], and those that share a vertex with one where with_beside,
    /// in their order. Waits once, and again where there are many more than last time.
    /// @param touches  all terms, by vertex; on the device
    /// @param x, v     [vertices] fields that a GPU works on [m], [m/s]; v may be empty
    NearTerms find(const ContactTouches& touches, int list_count, double margin, bool with_beside,
                   StepField x, StepField v);

    /// Takes what near.x and near.v, where it was asked for, have at the vertices of some of its terms to the
    /// fields of the last find().
    /// @param changed  into near.terms
    void take(const NearTerms& near, View<const int> changed);

private:
    void list(const ContactTouches& touches, int list_count, double margin, bool with_beside);
    void copy(View<const ContactTerm> terms, int most);
    void spread(View<const ContactTerm> terms);

    const CudaSpace& space_;
    StepField x_{View<Vec3>()}, v_{View<Vec3>()};
    int expected_ = 256;                          ///< near terms: somewhat more than the last times
    DeviceArray<unsigned char> near_, or_beside_; ///< [terms]
    DeviceArray<unsigned char> has_all_;          ///< [4 x terms]
    DeviceArray<int> list_;                       ///< [terms]
    SumScratch<int> count_;
    DeviceScratch scratch_;
    DeviceArray<ContactTerm> terms_; ///< [near terms]
    PinnedArray<ContactTerm> terms_here_;
    DeviceArray<NearVertices> x_there_; ///< [near terms]
    PinnedArray<NearVertices> x_start_;
    DeviceArray<Vec3> v_there_; ///< [4 x near terms] by term and vertex
    PinnedArray<Vec3> v_start_;
    std::vector<Vec3> x_here_, v_here_; ///< [vertices] those of near terms
    DeviceArray<PlacedVertex> placed_;
    PinnedArray<PlacedVertex> placed_here_;
};

} // namespace toile
