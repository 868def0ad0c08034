#include "core/quadrature/packing_kernels.h"

#include <numeric>

#include <gtest/gtest.h>

#include "core/compute/parallel.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/tables/quadrature_tables.h"
#include "tests/core/quadrature/quadrature_problems.h"

/// Lists with byte weights, built and summed by the GPU kernels on the CPU. No GPU is needed.
namespace toile::test {

namespace {

constexpr double kTolerance = 0.2;

/// One list in two parts.
struct SplitList {
    std::vector<int> packed_first, rest_first, packed_source, rest_source;
    std::vector<std::uint32_t> codes;
    std::vector<float> scales;
    std::vector<Floats<8>> rest_memory; // aligned as on a GPU
    View<float> rest_weights;

    SplitList(const EntryList& list, const PackingRule& rule, bool is_near, int words, int scale_count)
    {
        const int count = list.source.size();
        std::vector<int> chosen(count + 1, 0);
        parallel_for(kCpu, "test/choose", count, ChooseToPack{list, rule, chosen});
        std::vector<long> before(count + 1);
        std::exclusive_scan(chosen.begin(), chosen.end(), before.begin(), 0L);
        const PackedSlots slots{chosen, before};
        const size_t packed = before.back(), rest = count - packed;
        packed_source.resize(packed);
        codes.resize(packed * words);
        scales.resize(packed * scale_count);
        rest_source.resize(rest);
        rest_memory.resize(rest * list.rows * list.row_size / 8);
        if (!rest_memory.empty())
            rest_weights = View<float>(rest_memory.front().value, 8 * int(rest_memory.size()));
        packed_first.resize(list.first.size());
        rest_first.resize(list.first.size());
        parallel_for(kCpu, "test/firsts", list.first.size(),
                     SplitFirsts{slots, list.first, packed_first, rest_first});
        parallel_for(
            kCpu, "test/split", count,
            SplitEntry{list, slots, is_near, packed_source, codes, scales, rest_source, rest_weights});
    }
};

/// Quadrature with packed lists: moments and sums as on a GPU, one thread a leaf.
template <int Rank>
class PackedQuadrature : public GlobalSolver {
public:
    PackedQuadrature(std::shared_ptr<const QuadratureTables> tables, const SparseMatrix& H, double tolerance)
        : tables_(std::move(tables)), diagonal_(H.diagonal()),
          limits_(far_limits(tables_->tree, {diagonal_.data(), int(diagonal_.size())}, tolerance)),
          largest_(tables_->tree.leaf_count(), 0.0),
          near_(EntryList::near(table()), rule(), true, ClusterTree::kLeaf * PackedView::kWords, 2),
          far_(EntryList::far(table(), Rank), rule(), false, Rank * PackedView::kWords, Rank + 1)
    {
    }

    double packed_fraction() const
    {
        const double packed = double(near_.packed_source.size() + far_.packed_source.size());
        return packed / (packed + double(near_.rest_source.size() + far_.rest_source.size()));
    }

    void update(const SparseMatrix&, View<const unsigned char>) override {}
    bool is_symmetric() const override { return false; }
    void solve(View<const Vec3> b, View<Vec3> x) const override
    {
        const ClusterTree& tree = tables_->tree;
        const auto value = [&](int slot) {
            return tree.nodes()[slot] >= 0 ? b[tree.nodes()[slot]] : Vec3(Vec3::Zero());
        };
        std::vector<Vec3> sums(tree.cluster_count() * Rank);
        for (int level = 0; level < tree.level_count(); ++level)
            for (int c = 0; c < tree.level_size(level); ++c)
                tables_->basis.gather(level, c, Vec3(Vec3::Zero()), value, View<Vec3>(sums));
        std::vector<PaddedVec3> moments, sources;
        for (const Vec3& sum : sums)
            moments.push_back(padded(sum));
        for (int slot = 0; slot < tree.nodes().size(); ++slot)
            sources.push_back(padded(value(slot)));
        for (int leaf = 0; leaf < tree.leaf_count(); ++leaf)
            sum_leaf(leaf, sources, moments, x);
    }

private:
    KernelView table() const { return tables_->kernel.view(); }
    PackingRule rule()
    {
        const View<const int> nodes = tables_->tree.nodes();
        for (int slot = 0; slot < nodes.size(); ++slot)
            if (nodes[slot] >= 0)
                largest_[slot / 8] = std::max(largest_[slot / 8], diagonal_[nodes[slot]]);
        return {limits_, largest_};
    }

    void sum_leaf(int leaf, View<const PaddedVec3> sources, View<const PaddedVec3> moments,
                  View<Vec3> x) const
    {
        const PackedView packed{near_.packed_first, near_.packed_source, near_.codes, near_.scales,
                                far_.packed_first,  far_.packed_source,  far_.codes,  far_.scales};
        const KernelView rest{near_.rest_first, near_.rest_source, near_.rest_weights,
                              far_.rest_first,  far_.rest_source,  far_.rest_weights};
        PackedSum<Rank> all;
        all.add_near(packed, sources, all.near_rows(packed, leaf, 0, 1));
        all.add_far(packed, moments, all.far_rows(packed, leaf, 0, 1));
        all.sum.add_near(rest, sources, rest.near_of(leaf), {});
        all.sum.add_far(rest, moments, rest.far_of(leaf), {});
        for (int t = 0; t < 8; ++t)
            if (const int v = tables_->tree.nodes()[8 * leaf + t]; v >= 0)
                x[v] = Vec3(all.total(0)[t], all.total(1)[t], all.total(2)[t]);
    }

    std::shared_ptr<const QuadratureTables> tables_;
    Eigen::VectorXd diagonal_;
    std::vector<double> limits_, largest_;
    SplitList near_, far_;
};

/// Exact tables as a solver.
class Unpacked : public GlobalSolver {
public:
    explicit Unpacked(std::shared_ptr<const QuadratureTables> tables) : all_(std::move(tables)) {}
    void update(const SparseMatrix&, View<const unsigned char>) override {}
    void solve(View<const Vec3> b, View<Vec3> x) const override { all_.solve(b, x); }
    bool is_symmetric() const override { return false; }

private:
    QuadratureOperator all_;
};

double difference(const GlobalSolver& a, const GlobalSolver& b, int n)
{
    const std::vector<Vec3> load = random_field(n, 3);
    std::vector<Vec3> x(n), y(n);
    a.solve(load, x);
    b.solve(load, y);
    double max_difference = 0.0, largest = 0.0;
    for (int i = 0; i < n; ++i) {
        max_difference = std::max(max_difference, (x[i] - y[i]).cwiseAbs().maxCoeff());
        largest = std::max(largest, y[i].cwiseAbs().maxCoeff());
    }
    return max_difference / largest;
}

TEST(PackedLists, ContractLikeSinglePrecisionLists)
{
    const Grid grid;
    // The softest sheet reaches a few nodes; the stiffest moves as a whole, with a nearly constant kernel.
    for (const double shift : {1.0, 1e-1, 1e-4, 1e-7}) {
        const SparseMatrix H = grid.matrix(shift);
        const auto tables = build_tables({H, grid.fixed, grid.points, {}}, {});
        const PackedQuadrature<3> packed(tables, H, kTolerance);
        EXPECT_GT(packed.packed_fraction(), 0.98) << shift;
        const double single = contraction(Unpacked(tables), H);
        EXPECT_LT(contraction(packed, H), 1.1 * single) << shift;
    }
}

TEST(PackedLists, KeepSinglePrecisionWhereBytesAreTooCoarse)
{
    const Grid grid;
    const SparseMatrix H = grid.matrix(1e-4);
    const int n = int(H.rows());
    const auto tables = build_tables({H, grid.fixed, grid.points, {}}, {});
    const Unpacked single(tables);
    const PackedQuadrature<3> none(tables, H, 1e-9), some(tables, H, 0.02), all(tables, H, kTolerance);
    EXPECT_EQ(none.packed_fraction(), 0.0);
    EXPECT_LT(difference(none, single, n), 5e-6);
    EXPECT_GT(some.packed_fraction(), 0.2);
    EXPECT_LT(some.packed_fraction(), 0.95);
    EXPECT_LT(difference(some, single, n), difference(all, single, n));
}

TEST(PackedLists, HandleVolumes)
{
    const std::vector<EmbeddedPoint> cube = grid_points(10, 10, 10);
    const SparseMatrix H = grid_laplacian(10, 100, 1e-1);
    const std::vector<unsigned char> fixed(cube.size(), 0);
    const auto tables = build_tables({H, fixed, cube, {{0.07}, Extent::Volume}}, {});
    const PackedQuadrature<4> packed(tables, H, 0.07);
    EXPECT_GT(packed.packed_fraction(), 0.5);
    EXPECT_LT(contraction(packed, H), 1.1 * contraction(Unpacked(tables), H));
}

} // namespace
} // namespace toile::test
