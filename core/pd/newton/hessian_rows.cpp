#include "core/pd/newton/hessian_rows.h"

#include <algorithm>
#include <utility>

#include <Eigen/LU>

#include "core/compute/parallel.h"

namespace toile {

void HessianRows::find_pattern(const HessianParts& K, std::vector<int> order)
{
    order_ = std::move(order);
    row_of_.assign(K.fixed.size(), -1);
    for (int row = 0; row < size(); ++row)
        row_of_[order_[row]] = row;
    for (std::vector<int>* list : {&first_, &first_scalar_})
        list->assign(1, 0);
    for (std::vector<int>* list : {&columns_, &scalar_columns_, &scalar_source_})
        list->clear();
    source_.clear();
    for (const int i : order_) {
        const View<const int> neighbours = K.blocks.columns(i);
        const int* const begin = K.isotropic.innerIndexPtr() + K.isotropic.outerIndexPtr()[i];
        const int* const end = K.isotropic.innerIndexPtr() + K.isotropic.outerIndexPtr()[i + 1];
        for (int e = 0; e < neighbours.size(); ++e) {
            const int j = neighbours[e];
            if (j == i || row_of_[j] < 0)
                continue;
            const int* const found = std::lower_bound(begin, end, j);
            columns_.push_back(row_of_[j]);
            source_.push_back(
                {e, found != end && *found == j ? int(found - K.isotropic.innerIndexPtr()) : -1});
        }
        for (const int* entry = begin; entry != end; ++entry) {
            if (*entry == i || row_of_[*entry] < 0 ||
                std::binary_search(neighbours.begin(), neighbours.end(), *entry))
                continue;
            scalar_columns_.push_back(row_of_[*entry]);
            scalar_source_.push_back(int(entry - K.isotropic.innerIndexPtr()));
        }
        first_.push_back(int(columns_.size()));
        first_scalar_.push_back(int(scalar_columns_.size()));
    }
    blocks_.resize(columns_.size());
    scalars_.resize(scalar_columns_.size());
    sum_.resize(order_.size());
    inverse_diagonal_.resize(order_.size());
    term_sum_.resize(order_.size());
}

void HessianRows::update(const HessianParts& K)
{
    find_terms(K.whole_set ? std::vector<FrozenTerm>{} : K.terms);
    parallel_for(kCpu, "newton/rows", size(), [&](int row) { update_row(K, row); });
}

void HessianRows::update_row(const HessianParts& K, int row)
{
    const int i = order_[row];
    Mat3 sum = K.blocks.diagonal(i);
    double on_diagonal = K.inertia[i] + K.isotropic.coeff(i, i);
    for (int e = first_[row]; e < first_[row + 1]; ++e) {
        Mat3 block = K.blocks.blocks(i)[source_[e][0]];
        if (source_[e][1] >= 0)
            block.diagonal().array() += K.isotropic.valuePtr()[source_[e][1]];
        sum += block;
        blocks_[e] = padded_matrix(block);
    }
    for (int e = first_scalar_[row]; e < first_scalar_[row + 1]; ++e) {
        const double value = K.isotropic.valuePtr()[scalar_source_[e]];
        on_diagonal += value;
        scalars_[e] = float(value);
    }
    sum.diagonal().array() += on_diagonal;
    sum_[row] = padded_matrix(sum + term_sum_[row]);
    inverse_diagonal_[row] = padded_matrix(K.diagonal[i].inverse());
}

/// Sorts the terms: those with one vertex belong to its block, the others are lists by vertex.
void HessianRows::find_terms(const std::vector<FrozenTerm>& terms)
{
    std::fill(term_sum_.begin(), term_sum_.end(), Mat3::Zero());
    terms_.clear();
    entries_.clear();
    for (const FrozenTerm& term : terms) {
        CouplingTerm coupling;
        int count = 0;
        for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
            if (const int row = row_of_[term.vertex[k]]; row >= 0) {
                coupling.vertex[count] = row;
                coupling.weight[count++] = float(term.weight[k]);
            }
        if (count == 1) {
            const double weight = double(coupling.weight[0]);
            term_sum_[coupling.vertex[0]] += weight * weight * term.stiffness;
        } else if (count > 1) {
            coupling.stiffness = padded_matrix(term.stiffness);
            terms_.push_back(coupling);
        }
    }
    if (terms_.empty())
        return;
    first_entry_.assign(order_.size() + 1, 0);
    for (const CouplingTerm& term : terms_)
        for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
            ++first_entry_[term.vertex[k] + 1];
    for (int row = 0; row < size(); ++row)
        first_entry_[row + 1] += first_entry_[row];
    entries_.resize(first_entry_.back());
    std::vector<int> next(first_entry_.begin(), first_entry_.end() - 1);
    for (int t = 0; t < int(terms_.size()); ++t)
        for (int k = 0; k < 4 && terms_[t].vertex[k] >= 0; ++k)
            entries_[next[terms_[t].vertex[k]]++] = 4 * t + k;
}

} // namespace toile
