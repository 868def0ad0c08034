#include "collision/contact/cuda/contact_kernels.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "collision/contact/energy.h"

/// Kernels of contact terms by vertex, run on the CPU and compared with ContactEnergy. No GPU is needed.
namespace toile::test {

using namespace collision;

namespace {

/// Team of one thread.
struct OneThread {
    static constexpr int kThreads = 1;
    struct Flagged {
        int before, count;
    };
    int thread = 0;
    double sum(int, double value) const { return value; }
    Flagged flagged(bool flag) const { return {0, flag ? 1 : 0}; }
};

/// Some hundred terms of a few vertices, with colliders and between cloths. A third of them press; one in
/// nine has friction without pressing.
class ContactLists : public testing::Test {
protected:
    static constexpr int kVertices = 40, kTerms = 200;

    ContactLists()
    {
        for (Vec3& x : x_)
            x = Vec3(uniform_(random_), uniform_(random_), uniform_(random_));
        std::vector<ContactTerm> terms;
        terms.reserve(kTerms);
        for (int i = 0; i < kTerms; ++i)
            terms.push_back(some_term(i));
        energy_.set_terms(std::move(terms), kVertices);
        const auto& incidence = energy_.incidence();
        for (int k = 0; k < int(incidence.vertices.size()); ++k)
            EXPECT_LT(incidence.first[k], incidence.first[k + 1]);
    }

    ContactTerm some_term(int i)
    {
        ContactTerm term;
        const bool is_between = i % 2 == 0;
        term.pair.kind = is_between ? ContactKind::kClothVertexFace : ContactKind::kFaceVertex;
        for (int k = 0; k < (is_between ? 4 : 3); ++k) {
            term.pair.vertex[k] = (7 * i + 11 * k) % kVertices;
            term.pair.weight[k] = is_between && k > 0 ? -1.0 / 3.0 : is_between ? 1.0 : 1.0 / 3.0;
        }
        term.pair.normal = Vec3(uniform_(random_), uniform_(random_), 2.0).normalized();
        term.spring = {100.0 + i, 1e-3};
        term.friction = 0.3;
        term.normal_force = i % 9 == 1 ? 0.1 : 0.0;
        const double depth = i % 3 == 0 ? 1e-4 * (1 + i % 20) : -1e-3;
        term.offset = term.pair.gap(x_) + depth;
        term.anchor = term.pair.cloth_point(x_) + 1e-4 * Vec3(uniform_(random_), 1.0, 0.0);
        return term;
    }

    /// Evaluates all lists as DeviceContactEnergy::evaluate() does.
    void evaluate()
    {
        const auto& incidence = energy_.incidence();
        const ContactIncidence lists{energy_.terms(), incidence.first, incidence.entries};
        const EvaluateAndFreeze freeze{{energy_.terms(), x_, force_, term_energy_},
                                       {energy_.terms(), x_, is_true_, frozen_}};
        for (int i = 0; i < kTerms; ++i)
            freeze(i);
        active_count_ =
            int(std::count_if(frozen_.begin(), frozen_.end(), [](const auto& at) { return at.is_active(); }));
        count_.resize(incidence.vertices.size());
        entries_.resize(incidence.entries.size());
        blocks_.resize(incidence.vertices.size());
        const GatherContact gather{lists,     incidence.vertices, force_,  term_energy_,  frozen_,
                                   gradient_, vertex_energy_,     blocks_, device_lists()};
        for (int k = 0; k < int(incidence.vertices.size()); ++k)
            gather(k, OneThread{}, true);
    }
    FrozenRows device_lists() { return {energy_.incidence().first, count_, entries_}; }

    std::mt19937 random_{5};
    std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
    std::vector<Vec3> x_ = std::vector<Vec3>(kVertices);
    ContactEnergy energy_;
    bool is_true_ = false;
    int active_count_ = 0;
    std::vector<Vec3> force_ = std::vector<Vec3>(kTerms),
                      gradient_ = std::vector<Vec3>(kVertices, Vec3::Ones());
    std::vector<double> term_energy_ = std::vector<double>(kTerms),
                        vertex_energy_ = std::vector<double>(kVertices, 0.5);
    std::vector<FrozenContact> frozen_ = std::vector<FrozenContact>(kTerms);
    std::vector<int> count_;
    std::vector<FrozenRow> entries_;
    std::vector<Mat3> blocks_;
};

TEST_F(ContactLists, MatchTheGradientEnergyAndBoundsOfTheCpu)
{
    std::vector<Vec3> expected(kVertices, Vec3::Ones());
    const double value = energy_.add_gradient(x_, expected);
    ASSERT_TRUE(energy_.activate(x_));
    evaluate();
    double sum = -0.5 * kVertices;
    for (int v = 0; v < kVertices; ++v) {
        EXPECT_LT((gradient_[v] - expected[v]).norm(), 1e-14 * (1.0 + expected[v].norm())) << v;
        sum += vertex_energy_[v];
    }
    EXPECT_NEAR(sum, value, 1e-12 * value);
    const auto& vertices = energy_.incidence().vertices;
    for (int k = 0; k < int(vertices.size()); ++k) {
        const Mat3& bound = energy_.diagonal_blocks()[vertices[k]];
        EXPECT_LT((blocks_[k] - bound).norm(), 1e-14 * (1.0 + bound.norm())) << k;
    }
}

TEST_F(ContactLists, ListActiveTermsOnly)
{
    evaluate();
    EXPECT_GT(active_count_, kTerms / 4);
    EXPECT_LT(active_count_, kTerms / 2);
    int listed = 0, expected = 0;
    for (const int count : count_)
        listed += count;
    for (int i = 0; i < kTerms; ++i)
        expected += frozen_[i].is_active() ? energy_.terms()[i].pair.count() : 0;
    EXPECT_EQ(listed, expected);
}

TEST_F(ContactLists, MultiplyLikeTheFrozenHessian)
{
    for (const bool is_true : {false, true}) {
        is_true_ = is_true;
        energy_.use_true_hessian(is_true);
        ASSERT_TRUE(energy_.activate(x_));
        evaluate();
        std::vector<PaddedVec3> p;
        std::vector<Vec3> rounded, expected(kVertices, Vec3::Zero());
        for (int v = 0; v < kVertices; ++v) {
            p.push_back(padded(Vec3(uniform_(random_), uniform_(random_), uniform_(random_))));
            rounded.push_back(unpadded(p.back()));
        }
        energy_.add_hessian_product(rounded, expected);
        const auto& vertices = energy_.incidence().vertices;
        std::vector<Vec3> product(vertices.size());
        const MultiplyList multiply{device_lists(), p, product};
        double largest = 0.0;
        for (const Vec3& of_cpu : expected)
            largest = std::max(largest, of_cpu.norm());
        for (int k = 0; k < int(vertices.size()); ++k) {
            multiply(k, OneThread{}, true);
            EXPECT_LT((product[k] - expected[vertices[k]]).norm(), 2e-6 * largest) << k;
        }
    }
}

} // namespace
} // namespace toile::test
