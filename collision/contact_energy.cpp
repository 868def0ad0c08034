#include "collision/contact_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Friction's stiffness at slip length |u|: w while sticking, L/|u| while sliding.
double tangential_stiffness(const ContactTerm& term, double slip_length)
{
    const double limit = term.friction * term.normal_force;
    return term.stiffness * slip_length <= limit ? term.stiffness : limit / slip_length;
}

/// 1 with a collider, 2 where cloth meets cloth.
double total_weight(const ContactPair& pair) { return pair.is_between_cloths() ? 2.0 : 1.0; }

} // namespace

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
    frozen_.assign(terms_.size(), Mat3::Zero());
    term_force_.resize(terms_.size());
    term_energy_.resize(terms_.size());
    active_.clear();
    active_touches_.clear();
    blocks_.assign(vertex_count, Mat3::Zero());
}

double ContactEnergy::gap(int i, View<const Vec3> x) const
{
    const ContactTerm& term = terms_[i];
    return term.pair.gap(x) - term.offset;
}

double ContactEnergy::pressing_force(int i, View<const Vec3> x) const
{
    return terms_[i].stiffness * std::max(-gap(i, x), 0.0);
}

Vec3 ContactEnergy::slip(int i, View<const Vec3> x) const
{
    const ContactTerm& term = terms_[i];
    const Vec3 moved = term.pair.cloth_point(x) - term.anchor;
    return moved - term.pair.normal.dot(moved) * term.pair.normal;
}

/// out[v] += sum of weight * value(term) over the terms that touch v, in ascending order.
template <typename PerTerm>
void ContactEnergy::gather(const Touches& touches, View<Vec3> out, const PerTerm& value) const
{
    parallel_for(kCpu, "contact/gather", int(touches.vertices.size()), [&](int i) {
        Vec3 sum = Vec3::Zero();
        for (int k = touches.first[i]; k < touches.first[i + 1]; ++k) {
            const int term = touches.entries[k] / 4;
            sum += terms_[term].pair.weight[touches.entries[k] % 4] * value(term);
        }
        out[touches.vertices[i]] += sum;
    });
}

double ContactEnergy::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    const int count = int(terms_.size());
    parallel_for(kCpu, "contact/evaluate", count, [&](int i) {
        const ContactTerm& term = terms_[i];
        const double depth = std::min(gap(i, x), 0.0);
        term_force_[i] = term.stiffness * depth * term.pair.normal;
        term_energy_[i] = 0.5 * term.stiffness * depth * depth;

        const double limit = term.friction * term.normal_force;
        if (limit == 0.0)
            return;
        const Vec3 u = slip(i, x);
        const double length = u.norm();
        term_force_[i] += tangential_stiffness(term, length) * u;
        term_energy_[i] += term.stiffness * length <= limit
                               ? 0.5 * term.stiffness * length * length
                               : limit * length - 0.5 * limit * limit / term.stiffness;
    });
    gather(touches_, gradient, [&](int i) -> const Vec3& { return term_force_[i]; });
    return parallel_sum(kCpu, count, 0.0, [&](int i) { return term_energy_[i]; });
}

bool ContactEnergy::activate(View<const Vec3> x)
{
    parallel_for(kCpu, "contact/freeze", int(terms_.size()), [&](int i) {
        const ContactTerm& term = terms_[i];
        const Mat3 normal = term.pair.normal * term.pair.normal.transpose();
        frozen_[i].setZero();
        if (gap(i, x) < 0.0)
            frozen_[i] = term.stiffness * normal;
        if (term.friction * term.normal_force > 0.0)
            frozen_[i] += tangential_stiffness(term, slip(i, x).norm()) * (Mat3::Identity() - normal);
    });
    active_.clear();
    for (int i = 0; i < int(terms_.size()); ++i)
        if (!frozen_[i].isZero(0.0))
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
    for (size_t i = 0; i < touches_.vertices.size(); ++i) {
        const int v = touches_.vertices[i];
        for (int k = touches_.first[i]; k < touches_.first[i + 1]; ++k) {
            const int entry = touches_.entries[k], term = entry / 4;
            if (frozen_[term].isZero(0.0))
                continue;
            const ContactPair& pair = terms_[term].pair;
            blocks_[v] += std::abs(pair.weight[entry % 4]) * total_weight(pair) * frozen_[term];
            active_touches_.add(v, entry);
        }
    }
    active_touches_.close();
}

void ContactEnergy::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    parallel_for(kCpu, "contact/multiply", int(active_.size()), [&](int k) {
        const int i = active_[k];
        term_force_[i] = frozen_[i] * terms_[i].pair.cloth_point(p);
    });
    gather(active_touches_, out, [&](int i) -> const Vec3& { return term_force_[i]; });
}

void ContactEnergy::append_frozen_terms(std::vector<FrozenTerm>& terms) const
{
    for (const int i : active_)
        terms.push_back({terms_[i].pair.vertex, terms_[i].pair.weight, frozen_[i]});
}

} // namespace toile
