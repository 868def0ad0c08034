#pragma once

#include <cmath>
#include <random>
#include <string>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/pd/energy/frozen_hessian.h"
#include "core/pd/preconditioner/contact_preconditioner.h"

namespace toile::test {

/// dH from a list of terms.
class FrozenTerms : public FrozenHessian {
public:
    FrozenTerms(std::vector<FrozenTerm> terms, int vertex_count)
        : terms_(std::move(terms)), blocks_(vertex_count, Mat3::Zero())
    {
        for (const FrozenTerm& term : terms_) {
            double total = 0.0;
            for (const double weight : term.weight)
                total += std::abs(weight);
            for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                blocks_[term.vertex[k]] += std::abs(term.weight[k]) * total * term.stiffness;
        }
    }
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override
    {
        for (const FrozenTerm& term : terms_) {
            Vec3 point = Vec3::Zero();
            for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                point += term.weight[k] * p[term.vertex[k]];
            for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                out[term.vertex[k]] += term.weight[k] * (term.stiffness * point);
        }
    }
    View<const Mat3> diagonal_blocks() const override { return blocks_; }
    void append_terms(std::vector<FrozenTerm>& terms) const override
    {
        terms.insert(terms.end(), terms_.begin(), terms_.end());
    }

    /// dH of the free vertices as numbers, coordinates of a vertex next to each other.
    Eigen::MatrixXd dense(const std::vector<unsigned char>& fixed) const
    {
        Eigen::MatrixXd dH = Eigen::MatrixXd::Zero(3 * long(fixed.size()), 3 * long(fixed.size()));
        for (const FrozenTerm& term : terms_)
            for (int k = 0; k < 4 && term.vertex[k] >= 0; ++k)
                for (int j = 0; j < 4 && term.vertex[j] >= 0; ++j)
                    if (!fixed[term.vertex[k]] && !fixed[term.vertex[j]])
                        dH.block<3, 3>(3 * term.vertex[k], 3 * term.vertex[j]) +=
                            term.weight[k] * term.weight[j] * term.stiffness;
        return dH;
    }

private:
    std::vector<FrozenTerm> terms_;
    std::vector<Mat3> blocks_;
};

/// Stiffness along one direction, or along all as for sticking friction.
inline Mat3 random_stiffness(double stiffest, std::mt19937& random)
{
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    const Vec3 n = Vec3(value(random), value(random), value(random)).normalized();
    const double w = stiffest * (0.6 + 0.4 * value(random));
    return random() % 2 == 0 ? Mat3(w * n * n.transpose())
                             : Mat3(w * (Mat3::Identity() - 0.7 * n * n.transpose()));
}

/// Terms of a vertex against a triangle: signed weights, sum zero. Term i acts on four of vertices 0 to n -
/// 1: disjoint ones if `is_disjoint`, else any.
inline std::vector<FrozenTerm> coupled_terms(int count, int n, bool is_disjoint, double stiffest)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> fraction(0.1, 0.4);
    std::vector<FrozenTerm> terms(count);
    for (int i = 0; i < count; ++i) {
        FrozenTerm& term = terms[i];
        for (int k = 0; k < 4; ++k)
            term.vertex[k] =
                is_disjoint ? 4 * i + k : int((unsigned(n / 4) * unsigned(k)) + random() % unsigned(n / 4));
        const double a = fraction(random), b = fraction(random);
        term.weight = {1.0, -a, -b, a + b - 1.0};
        term.stiffness = random_stiffness(stiffest, random);
    }
    return terms;
}

/// Name of a parameterised test.
inline std::string name_of(const testing::TestParamInfo<ContactPreconditioner>& test)
{
    constexpr const char* kNames[] = {"Block", "Exact", "ShermanMorrison", "Chebyshev", "Paper"};
    return kNames[int(test.param)];
}

} // namespace toile::test
