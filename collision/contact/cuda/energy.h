#pragma once

#include "collision/contact/kernels.h"
#include "core/compute/cuda/report.h"
#include "core/compute/cuda/sort.h"
#include "core/compute/gauss_seidel.h"
#include "core/pd/cuda/active_set.h"

namespace toile::collision {

/// ContactEnergy on a GPU.
class DeviceContactEnergy : public DeviceActiveSet {
public:
    /// @param space  borrowed
    explicit DeviceContactEnergy(const CudaSpace& space);

    /// Terms for the caller to write, followed by build_incidence(). Grows the capacity if needed.
    View<ContactTerm> reserve(int count);
    /// Lists the terms of each vertex. Waits.
    void build_incidence(int vertex_count);

    /// Copies terms from the host.
    void set_terms(View<const ContactTerm> terms, int vertex_count);

    /// See StepStart::wants_true_hessian.
    void use_true_hessian(bool use) { has_true_hessian_ = use; }

    View<const ContactTerm> terms() const { return terms_.view(); }
    View<ContactTerm> change_terms() { return terms_.view(); } ///< vertices must not change
    View<const int> vertices() const
    {
        return vertices_.view();
    } ///< [lists] see ContactEnergy::TermIncidence
    ContactIncidence incidence() const { return {terms_.view(), first_.view(), entries_.view()}; }

    SharedLists lists() const { return {list_of_.view(), first_.view(), entries_.view()}; }

    bool has_terms() const override { return terms_.size() > 0; }
    void evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy) override;
    void multiply(View<const PaddedVec3> p) override;
    Frozen frozen() const override;

private:
    FrozenRows rows() const;

    const CudaSpace& space_;
    int capacity_ = 0; ///< terms
    DeviceArray<ContactTerm> terms_;
    DeviceArray<int> vertices_, first_, entries_; ///< ContactEnergy::TermIncidence
    DeviceArray<int> list_of_;                    ///< [vertices] see Frozen
    DeviceArray<Vec3> force_;                     ///< [terms] [N]
    DeviceArray<double> term_energy_;             ///< [terms] [J]
    DeviceArray<FrozenContact> frozen_;           ///< [terms]
    DeviceArray<Mat3> blocks_;                    ///< [lists]
    DeviceArray<Vec3> product_;                   ///< [lists] [N]
    mutable DeviceArray<int> active_count_;       ///< [lists] see FrozenRows
    mutable DeviceArray<FrozenRow> rows_;         ///< [4 x terms] likewise
    bool has_true_hessian_ = false;
    SortArrays sort_;                  ///< [4 x terms] by vertex
    DeviceArray<unsigned char> flags_; ///< [4 x terms + 1]
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile::collision
