#include <random>

#include <gtest/gtest.h>

#include "core/linear/pcg.h"
#include "core/pd/cuda/nested_pcg_kernels.h"

namespace toile::test {

namespace {

constexpr int kCount = 60, kPressing = 7;

/// H of a chain whose last vertex is fixed and some of whose vertices press.
struct Chain {
    std::vector<int> first, column;
    std::vector<float> value, sum;
    std::vector<int> slices;
    std::vector<RowEntry> entries;
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
                value.push_back(i == j ? 2.125F : -1.0F);
            }
            diagonal.push_back(2.125);
            sum.push_back(i == 0 || i + 1 == kCount ? 1.125F : 0.125F);
        }
        first.push_back(int(column.size()));
        const WholeRows rows(first, column, value);
        slices = rows.first;
        entries = rows.entries;
        for (int k = 0; k < kPressing; ++k) {
            vertices.push_back(5 + 7 * k);
            list_of[vertices[k]] = k + 1;
            const Vec3 n = Vec3(1.0, 0.3 * k, -0.2 * k).normalized();
            blocks.push_back(4.0 * n * n.transpose());
        }
        for (int k = 0; k < kPressing; ++k)
            inverse[k] = Mat3(blocks[k] + diagonal[vertices[k]] * Mat3::Identity()).inverse();
    }

    SystemRows rows() const { return {slices, entries, sum, fixed}; }
    DeviceActiveSet::Frozen frozen() const { return {list_of, vertices, {}, blocks, {}}; }
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

    /// Applies an inverse that is neither exact nor symmetric; zero at the fixed vertex.
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
            scaled[i] = diagonal[i] * blocks_inverse().of(i)(r[i]);
        solve(scaled, solved);
        for (int i = 0; i < kCount; ++i)
            z[i] = blocks_inverse().of(i)(r[i] + diagonal[i] * solved[i]);
    }
};

/// Random forces, zero at the fixed vertex.
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

/// Iterations by the GPU kernels.
class Iterations {
public:
    Iterations(const Chain& chain, View<const Vec3> b, const Pcg::Settings& settings = kEndless)
        : chain_(chain), settings_(settings)
    {
        for (int i = 0; i < kCount; ++i)
            scaled_[i] =
                unpadded(BeginPcg{b, fields(), {chain_.frozen(), chain_.diagonal, inverse_}, scalars_}(i));
    }

    void take(int count)
    {
        const PcgFields fields = this->fields();
        const BlocksInverse E{chain_.list_of, inverse_, chain_.diagonal};
        for (int k = 0; k < count; ++k) {
            Chain::solve(scaled_, solved_);
            for (int i = 0; i < kCount; ++i)
                FinishPrecondition{fields, E, scalars_}(i, padded(solved_[i]));
            for (int l = 0; l < kPressing; ++l)
                product_[l] = chain_.blocks[l] * unpadded(fields.z[chain_.vertices[l]]);
            PcgSums sums;
            for (int i = 0; i < kCount; ++i)
                sums += MultiplySystem{fields, chain_.rows(), chain_.list_of, product_}(i);
            FindStep{scalars_, settings_}(sums);
            for (int i = 0; i < kCount; ++i)
                scaled_[i] = unpadded(TakeStep{fields, E, scalars_, {report_, unsigned(k + 1)}}(i));
        }
    }

    const std::vector<Vec3>& x() const { return x_; }
    const PcgScalars& scalars() const { return scalars_[0]; }

private:
    static constexpr Pcg::Settings kEndless{.tolerance = 0.0, .max_iterations = 100};
    using Field = std::vector<PaddedVec3>;

    PcgFields fields() { return {x_, field_[0], field_[1], field_[2], field_[3], field_[4], field_[5]}; }

    const Chain& chain_;
    Pcg::Settings settings_;
    std::vector<Field> field_ = std::vector<Field>(6, Field(kCount, PaddedVec3(0.0F)));
    std::vector<Vec3> x_ = std::vector<Vec3>(kCount), scaled_ = x_, solved_ = x_;
    std::vector<Vec3> product_ = std::vector<Vec3>(kPressing);
    std::vector<Mat3> inverse_ = std::vector<Mat3>(kPressing);
    std::vector<PcgScalars> scalars_ = std::vector<PcgScalars>(1);
    std::vector<Reported<PcgScalars>> report_ = std::vector<Reported<PcgScalars>>(1);
};

TEST(NestedPcgKernels, MatchTheIterationsOfPcg)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    for (const int iterations : {1, 2, 5, 9}) {
        std::vector<Vec3> expected(kCount);
        Pcg pcg;
        const Pcg::Outcome outcome =
            pcg.solve([&](View<const Vec3> p, View<Vec3> out) { chain.multiply(p, out); },
                      [&](View<const Vec3> r, View<Vec3> z) { chain.precondition(r, z); }, b, expected,
                      {.tolerance = 0.0, .max_iterations = iterations, .is_flexible = true});
        Iterations solve(chain, b);
        solve.take(iterations);
        for (int i = 0; i < kCount; ++i)
            EXPECT_LT((solve.x()[i] - expected[i]).norm(), 1e-6) << i;
        EXPECT_NEAR(solve.scalars().residual, outcome.residual, 1e-6);
        EXPECT_EQ(solve.scalars().iterations, iterations);
        EXPECT_GT(solve.scalars().gain, 0.0);
    }
}

TEST(NestedPcgKernels, GainsSumToTheDecreaseOfTheQuadratic)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    std::vector<Vec3> product(kCount);
    Iterations solve(chain, b);
    double gain = 0.0;
    for (int k = 1; k <= 6; ++k) {
        solve.take(1);
        gain += solve.scalars().gain;
        chain.multiply(solve.x(), product);
        const double value = 0.5 * dot(solve.x(), product) - dot(b, solve.x());
        EXPECT_NEAR(value, -0.5 * gain, 1e-6 * gain) << k;
    }
}

/// Elastic rows in which inertia is below the rounding of the diagonal, under a translation.
TEST(NestedPcgKernels, KeepInertiaBesideStiffness)
{
    constexpr double kStiffness = 1e5, kInertia = 1e-3;
    const std::vector<int> first{0, 3}, column{0, 1, 2};
    const double diagonal = 2.0 * kStiffness / 3.0 + kInertia;
    const std::vector<float> value{float(diagonal), float(-kStiffness / 3.0), float(-kStiffness / 3.0)};
    const std::vector<float> sum{float(kInertia)};
    const std::vector<unsigned char> fixed{0};
    const std::vector<PaddedVec3> move(3, padded(Vec3(0.3, -1.7, 2.9)));
    const WholeRows sliced(first, column, value);
    const SystemRows rows{sliced.first, sliced.entries, sum, fixed};
    const PaddedVec3 product = rows.times(rows.row(0), move[0], move);
    for (int a = 0; a < 3; ++a)
        EXPECT_FLOAT_EQ(product[a], float(kInertia) * move[0][a]);
}

TEST(NestedPcgKernels, EndAtTheSameIterationAsPcg)
{
    const Chain chain;
    const std::vector<Vec3> b = random_forces();
    for (Pcg::Settings settings : {Pcg::Settings{.tolerance = 0.0, .max_iterations = 3},
                                   Pcg::Settings{.tolerance = 0.1, .max_iterations = 100},
                                   Pcg::Settings{.tolerance = 0.0, .max_iterations = 100, .min_gain = 0.5}}) {
        settings.is_flexible = true;
        std::vector<Vec3> expected(kCount);
        Pcg pcg;
        const Pcg::Outcome outcome = pcg.solve(
            [&](View<const Vec3> p, View<Vec3> out) { chain.multiply(p, out); },
            [&](View<const Vec3> r, View<Vec3> z) { chain.precondition(r, z); }, b, expected, settings);
        Iterations solve(chain, b, settings);
        while (!solve.scalars().is_over && solve.scalars().iterations < 20)
            solve.take(1);
        EXPECT_EQ(solve.scalars().iterations, outcome.iterations);
        EXPECT_FALSE(solve.scalars().is_void);
    }
}

TEST(NestedPcgKernels, ReturnZeroForZeroForces)
{
    const Chain chain;
    const std::vector<Vec3> nothing(kCount, Vec3::Zero());
    Iterations solve(chain, nothing);
    solve.take(1);
    EXPECT_TRUE(solve.scalars().is_over);
    EXPECT_EQ(solve.scalars().iterations, 0);
    EXPECT_EQ(solve.x(), nothing);
}

} // namespace
} // namespace toile::test
