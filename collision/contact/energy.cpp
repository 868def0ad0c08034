#include "collision/contact/energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/compute/parallel.h"

namespace toile::collision {

void ContactEnergy::TermIncidence::clear()
{
    vertices.clear();
    first.clear();
    entries.clear();
}

void ContactEnergy::TermIncidence::add(int vertex, int entry)
{
    if (vertices.empty() || vertices.back() != vertex) {
        vertices.push_back(vertex);
        first.push_back(int(entries.size()));
    }
    entries.push_back(entry);
}

void ContactEnergy::set_terms(std::vector<ContactTerm> terms, int vertex_count)
{
    terms_ = std::move(terms);
    std::vector<std::pair<int, int>> incidence; // (vertex, 4 * term + slot)
    for (int i = 0; i < int(terms_.size()); ++i)
        for (int k = 0; k < terms_[i].pair.count(); ++k)
            incidence.emplace_back(terms_[i].pair.vertex[k], 4 * i + k);
    std::sort(incidence.begin(), incidence.end());
    incidence_.clear();
    for (const auto& [v, entry] : incidence)
        incidence_.add(v, entry);
    incidence_.close();
    frozen_.assign(terms_.size(), FrozenContact{});
    term_force_.resize(terms_.size());
    term_energy_.resize(terms_.size());
    active_.clear();
    active_incidence_.clear();
    blocks_.assign(vertex_count, Mat3::Zero());
}

/// out[v] += sum of weight * force over the terms at v, in ascending order.
void ContactEnergy::gather(const TermIncidence& incidence, View<Vec3> out) const
{
    const ContactIncidence lists{terms_, incidence.first, incidence.entries};
    parallel_for(kCpu, "contact/gather", int(incidence.vertices.size()),
                 [&](int i) { out[incidence.vertices[i]] += lists.force(i, term_force_); });
}

double ContactEnergy::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    const int count = int(terms_.size());
    parallel_for(kCpu, "contact/evaluate", count, EvaluateContact{terms_, x, term_force_, term_energy_});
    gather(incidence_, gradient);
    return parallel_sum(kCpu, count, 0.0, [&](int i) { return term_energy_[i]; });
}

bool ContactEnergy::activate(View<const Vec3> x)
{
    parallel_for(kCpu, "contact/freeze", int(terms_.size()),
                 FreezeContact{terms_, x, has_true_hessian_, frozen_});
    active_.clear();
    for (int i = 0; i < int(terms_.size()); ++i)
        if (frozen_[i].is_active())
            active_.push_back(i);
    find_active_incidence();
    return !active_.empty();
}

/// Finds the incidence of the active terms, and the blocks of their vertices.
void ContactEnergy::find_active_incidence()
{
    for (const int v : active_incidence_.vertices)
        blocks_[v].setZero();
    active_incidence_.clear();
    for (size_t i = 0; i < incidence_.vertices.size(); ++i)
        for (int k = incidence_.first[i]; k < incidence_.first[i + 1]; ++k)
            if (frozen_[incidence_.entries[k] / 4].is_active())
                active_incidence_.add(incidence_.vertices[i], incidence_.entries[k]);
    active_incidence_.close();
    const ContactIncidence lists{terms_, active_incidence_.first, active_incidence_.entries};
    parallel_for(kCpu, "contact/blocks", int(active_incidence_.vertices.size()),
                 [&](int i) { blocks_[active_incidence_.vertices[i]] = lists.block(i, frozen_); });
}

void ContactEnergy::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    const MultiplyContact multiply{terms_, frozen_, p, term_force_};
    parallel_for(kCpu, "contact/multiply", int(active_.size()), [&](int k) { multiply(active_[k]); });
    gather(active_incidence_, out);
}

void ContactEnergy::append_frozen_terms(std::vector<FrozenTerm>& terms) const
{
    for (const int i : active_) {
        const ContactPair& pair = terms_[i].pair;
        terms.push_back({pair.vertex, pair.weight, frozen_[i].matrix(pair.normal)});
    }
}

} // namespace toile::collision
