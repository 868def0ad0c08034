#include <random>

#include <gtest/gtest.h>

#include "core/linear/pcg.h"
#include "core/pd/device/nested_pcg_kernels.h"

namespace toile {
namespace {

constexpr int kCount = 60, kPressing = 7;

/// H of a chain whose last vertex is held, some vertices of which press.
struct Chain {
    std::vector<int> first, column;
    std::vector<float> value;
    std::vector<double> diagonal;
    std::vector<unsigned char> fixed = std::vector<unsigned char>(kCount, 0);
    std::vector<int> list_of = std::vector<int>(kCount, 0);
    std::vector<int> vertices;
    std::vector<Mat3> blocks, inverse = std::vector<Mat3>(kPressing);

    Chain()
    {
        fixed.back() = 1;
        for (int i = 0; i < kCount; ++i) {
            first.push_back(int(column.size()));
            for (const int j : {i - 1, i, i + 1}) {
                if (j < 0 || j >= kCount)
                    continue;
                column.push_back(j);
                value.push_back(i == j ? 2.1F : -1.0F);
            }
            diagonal.push_back(2.1);
        }
        first.push_back(int(column.size()));
        for (int k = 0; k < kPressing; ++k) {
            vertices.push_back(5 + 7 * k);
            list_of[vertices[k]] = k + 1;
            const Vec3 n = Vec3(1.0, 0.3 * k, -0.2 * k).normalized();
            blocks.push_back(4.0 * n * n.transpose());
        }
        for (int k = 0; k < kPressing; ++k)
            InvertBlock{vertices, blocks, diagonal, inverse}(k);
    }

    SystemRows rows() const { return {first, column, value, diagonal, fixed}; }
    BlocksInverse blocks_inverse() const { return {list_of, inverse, diagonal}; }

    void multiply(View<const Vec3> p, View<Vec3> out) const
    {
        for (int i = 0; i < kCount; ++i) {
            out[i] = p[i];
            if (fixed[i])
                continue;
            out[i].setZero();
            for (int k = first[i]; k < first[i + 1]; ++k)
                out[i] += double(value[k]) * p[column[k]];
            if (list_of[i] > 0)
                out[i] += blocks[list_of[i] - 1] * p[i];
        }
    }

    /// An inverse that is neither right nor symmetric, where nothing is held.
    static void solve(View<const Vec3> b, View<Vec3> x)
    {
        for (int i = 0; i + 1 < kCount; ++i)
            x[i] = 0.6 * b[i] + 0.2 * b[std::max(i - 1, 0)] + 0.15 * b[i + 1];
        x[kCount - 1].setZero();
    }

    void precondition(View<const Vec3> r, View<Vec3> z) const
    {
        std::vector<Vec3> scaled(kCount), solved(kCount);
        for (int i = 0; i < kCount; ++i)
            scaled[i] = diagonal[i] * blocks_inverse()(i, r[i]);
        solve(scaled, solved);
        for (int i = 0; i < kCount; ++i)
            z[i] = blocks_inverse()(i, r[i] + diagonal[i] * solved[i]);
    }
};

/// Zero where the chain is held.
std::vector<Vec3> random_forces()
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    std::vector<Vec3> field(kCount);
    for (Vec3& v : field)
        v = Vec3(number(random), number(random), number(random));
    field.back().setZero();
    return field;
}

/// Iterations as a GPU does them.
PcgScalars iterate(const Chain& chain, View<const Vec3> b, int iterations, std::vector<Vec3>& x,
                   const Pcg::Settings& settings = {.tolerance = 0.0, .max_iterations = 100})
{
    std::vector<std::vector<PaddedVec3>> field(6, std::vector<PaddedVec3>(kCount, PaddedVec3(0.0F)));
    x.resize(kCount);
    std::vector<Vec3> product(kPressing), scaled(kCount), solved(kCount);
    std::vector<PcgScalars> scalars(1);
    const PcgFields fields{x, field[0], field[1], field[2], field[3], field[4], field[5], scaled, solved};
    for (int i = 0; i < kCount; ++i)
        BeginPcg{b, fields, chain.blocks_inverse(), scalars}(i);
    for (int k = 0; k < iterations; ++k) {
        Chain::solve(fields.scaled, fields.solved);
        for (int i = 0; i < kCount; ++i)
            FinishPrecondition{fields, chain.blocks_inverse()}(i);
        for (int l = 0; l < kPressing; ++l)
            product[l] = chain.blocks[l] * unpadded(fields.z[chain.vertices[l]]);
        PcgSums sums;
        for (int i = 0; i < kCount; ++i)
            sums += MultiplySystem{fields, chain.rows(), chain.list_of, product}(i);
        FindStep{scalars, settings}(sums);
        for (int i = 0; i < kCount; ++i)
            TakeStep{fields, chain.blocks_inverse(), scalars}(i);
    }
    return scalars[0];
}

TEST(NestedPcgKernels, TakeTheIterationsOfPcg)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    for (const int iterations : {1, 2, 5, 9}) {
        std::vector<Vec3> expected(kCount), x;
        Pcg pcg;
        const Pcg::Outcome outcome =
            pcg.solve([&](View<const Vec3> p, View<Vec3> out) { chain.multiply(p, out); },
                      [&](View<const Vec3> r, View<Vec3> z) { chain.precondition(r, z); }, b, expected,
                      {.tolerance = 0.0, .max_iterations = iterations, .is_flexible = true});
        const PcgScalars found = iterate(chain, b, iterations, x);
        for (int i = 0; i < kCount; ++i)
            EXPECT_LT((x[i] - expected[i]).norm(), 1e-6) << i;
        EXPECT_NEAR(found.residual, outcome.residual, 1e-6);
        EXPECT_EQ(found.iterations, iterations);
        EXPECT_GT(found.gain, 0.0);
    }
}

TEST(NestedPcgKernels, GainsAddUpToWhatTheQuadraticLoses)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    double gain = 0.0;
    for (int k = 1; k <= 6; ++k) {
        std::vector<Vec3> x, product(kCount);
        gain += iterate(chain, b, k, x).gain;
        chain.multiply(x, product);
        const double value = 0.5 * dot(x, product) - dot(b, x);
        EXPECT_NEAR(value, -0.5 * gain, 1e-6 * gain) << k;
    }
}

TEST(NestedPcgKernels, ChangeNothingPastTheEnd)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    for (const Pcg::Settings& settings :
         {Pcg::Settings{.tolerance = 0.0, .max_iterations = 3},
          Pcg::Settings{.tolerance = 0.1, .max_iterations = 100},
          Pcg::Settings{.tolerance = 0.0, .max_iterations = 100, .least_gain = 0.5}}) {
        std::vector<Vec3> expected, x;
        const int last = iterate(chain, b, 30, expected, settings).iterations;
        ASSERT_LT(last, 20);
        EXPECT_FALSE(iterate(chain, b, last - 1, x, settings).is_over);
        EXPECT_TRUE(iterate(chain, b, last, x, settings).is_over);
        EXPECT_EQ(x, expected);
    }
}

TEST(NestedPcgKernels, StandStillWhereNothingIsAsked)
{
    const Chain chain;
    const std::vector<Vec3> nothing(kCount, Vec3::Zero());
    std::vector<Vec3> x;
    EXPECT_EQ(iterate(chain, nothing, 2, x).iterations, 0);
    EXPECT_EQ(x, nothing);
}

} // namespace
} // namespace toile
