#include "collision/contact_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/backend/parallel.h"

namespace toile {

void ContactEnergy::Touches::clear()
{
    vertices.clear();
    first.clear();
    entries.clear();
}

void ContactEnergy::Touches::add(int vertex, int entry)
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
    touches_.clear();
    for (const auto& [v, entry] : incidence)
        touches_.add(v, entry);
    touches_.close();
    frozen_.assign(terms_.size(), FrozenContact{});
    term_force_.resize(terms_.size());
    term_energy_.resize(terms_.size());
    active_.clear();
    active_touches_.clear();
    blocks_.assign(vertex_count, Mat3::Zero());
}

/// out[v] += sum of weight * force over the terms that touch v, in ascending order.
void ContactEnergy::gather(const Touches& touches, View<Vec3> out) const
{
    const ContactTouches lists{terms_, touches.first, touches.entries};
    parallel_for(kCpu, "contact/gather", int(touches.vertices.size()),
                 [&](int i) { out[touches.vertices[i]] += lists.force(i, term_force_); });
}

double ContactEnergy::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    const int count = int(terms_.size());
    parallel_for(kCpu, "contact/evaluate", count, EvaluateContact{terms_, x, term_force_, term_energy_});
    gather(touches_, gradient);
    return parallel_sum(kCpu, count, 0.0, [&](int i) { return term_energy_[i]; });
}

bool ContactEnergy::activate(View<const Vec3> x)
{
    parallel_for(kCpu, "contact/freeze", int(terms_.size()), FreezeContact{terms_, x, frozen_});
    active_.clear();
    for (int i = 0; i < int(terms_.size()); ++i)
        if (frozen_[i].acts())
            active_.push_back(i);
    find_active_touches();
    return !active_.empty();
}

/// Touches of the frozen terms, and the blocks of their vertices.
void ContactEnergy::find_active_touches()
{
    for (const int v : active_touches_.vertices)
        blocks_[v].setZero();
    active_touches_.clear();
    for (size_t i = 0; i < touches_.vertices.size(); ++i)
        for (int k = touches_.first[i]; k < touches_.first[i + 1]; ++k)
            if (frozen_[touches_.entries[k] / 4].acts())
                active_touches_.add(touches_.vertices[i], touches_.entries[k]);
    active_touches_.close();
    const ContactTouches lists{terms_, active_touches_.first, active_touches_.entries};
    parallel_for(kCpu, "contact/blocks", int(active_touches_.vertices.size()),
                 [&](int i) { blocks_[active_touches_.vertices[i]] = lists.block(i, frozen_); });
}

void ContactEnergy::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    const MultiplyContact multiply{terms_, frozen_, p, term_force_};
    parallel_for(kCpu, "contact/multiply", int(active_.size()), [&](int k) { multiply(active_[k]); });
    gather(active_touches_, out);
}

void ContactEnergy::append_frozen_terms(std::vector<FrozenTerm>& terms) const
{
    for (const int i : active_)
        terms.push_back(
            {terms_[i].pair.vertex, terms_[i].pair.weight, frozen_[i].matrix(terms_[i].pair.normal)});
}

} // namespace toile
