/// near_pairs [THREADS]: compares NearPairs with one query of Embree's tree per primitive, and with
/// rtcCollide, as CSV on stdout. Times are the minimum of several, on one thread by default. Exits with 1 if
/// they find different numbers of pairs.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "collision/self/near_pairs.h"
#include "core/compute/parallel.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/near_pairs/by_collide.h"
#include "research/benchmarks/near_pairs/by_point_queries.h"
#include "research/benchmarks/near_pairs/cases.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::near_pairs {

namespace {

constexpr double kMargin = 0.004;    // [m]
constexpr double kSecondsEach = 1.0; // [s] of repetitions

Row measure(const Case& cloth)
{
    std::vector<collision::NearPair> pairs;
    collision::NearPairs near(cloth.triangles, cloth.x, {}, collision::NearPairs::Keeping::kNothing);
    const double tree_ms = best_ms(kSecondsEach, [&] { near.find(cloth.x, {}, kMargin, pairs); });
    collision::NearPairs keeping(cloth.triangles, cloth.x);
    for (int searches = 0; searches < 2; ++searches) // one, and one that keeps pairs
        keeping.find(cloth.x, {}, kMargin, pairs);
    const double kept_ms = best_ms(kSecondsEach, [&] { keeping.find(cloth.x, {}, kMargin, pairs); });

    ByPointQueries queries(cloth.triangles, cloth.x);
    size_t count = 0;
    const double query_ms = best_ms(kSecondsEach, [&] { count = queries.find(cloth.x, kMargin); });

    ByCollide collide(cloth.triangles, cloth.x);
    size_t collide_count = 0, candidates = 0;
    const double collide_ms = best_ms(kSecondsEach, [&] { collide_count = collide.find(cloth.x, kMargin); });
    const double candidates_ms =
        best_ms(kSecondsEach, [&] { candidates = collide.find_candidates(cloth.x, kMargin); });
    const double build_ms = best_ms(kSecondsEach, [&] { collision::NearPairs(cloth.triangles, cloth.x); });

    if (pairs.size() != count || pairs.size() != collide_count)
        throw std::runtime_error(cloth.name + ": " + std::to_string(pairs.size()) + " pairs by NearPairs, " +
                                 std::to_string(count) + " by point queries, " +
                                 std::to_string(collide_count) + " by rtcCollide");
    const auto facing =
        std::count_if(pairs.begin(), pairs.end(), [](const collision::NearPair& p) { return p.is_facing; });
    return {cloth.name,
            std::to_string(cloth.x.size()),
            std::to_string(cloth.triangles.size()),
            std::to_string(pairs.size()),
            std::to_string(count),
            std::to_string(collide_count),
            std::to_string(facing),
            std::to_string(candidates),
            format("%.2f", build_ms),
            format("%.2f", tree_ms),
            format("%.2f", kept_ms),
            format("%.2f", query_ms),
            format("%.2f", collide_ms),
            format("%.2f", candidates_ms)};
}

} // namespace

} // namespace toile::research::near_pairs

int main(int argc, char** argv)
{
    using namespace toile;
    using namespace toile::research;
    try {
        const ThreadLimit limit(argc > 1 ? std::atoi(argv[1]) : 1);
        std::vector<research::Row> rows;
        for (const int vertices : {2500, 10000, 50000})
            for (const near_pairs::Case& cloth : near_pairs::cases(vertices))
                rows.push_back(near_pairs::measure(cloth));
        const Row header{"case",
                         "vertices",
                         "triangles",
                         "pairs",
                         "pairs_by_queries",
                         "pairs_by_collide",
                         "facing",
                         "collide_candidates",
                         "build_edges_and_tree_ms",
                         "find_ms",
                         "find_again_ms",
                         "point_queries_ms",
                         "collide_ms",
                         "collide_candidates_ms"};
        std::fputs(research::csv(header, rows).c_str(), stdout);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "near_pairs: %s\n", error.what());
        return 1;
    }
    return 0;
}
