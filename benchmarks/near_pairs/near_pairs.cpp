/// near_pairs [THREADS]: NearPairs against one query of Embree's tree per primitive, as CSV on stdout. Times
/// are the best of several, on one thread if not told otherwise.

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "benchmarks/best_time.h"
#include "benchmarks/near_pairs/by_point_queries.h"
#include "benchmarks/near_pairs/cases.h"
#include "benchmarks/text_table.h"
#include "collision/cloth/near_pairs.h"
#include "core/backend/parallel.h"

namespace toile::near_pairs {

namespace {

constexpr double kMargin = 0.004;    // [m]
constexpr double kSecondsEach = 1.0; // [s] of repetitions

Row measure(const Case& cloth)
{
    std::vector<NearPair> pairs;
    NearPairs near(cloth.triangles, cloth.x);
    const double tree_ms = best_ms(kSecondsEach, [&] { near.find(cloth.x, {}, kMargin, pairs); });

    ByPointQueries queries(cloth.triangles, cloth.x);
    size_t count = 0;
    const double query_ms = best_ms(kSecondsEach, [&] { count = queries.find(cloth.x, kMargin); });
    const double build_ms = best_ms(kSecondsEach, [&] { NearPairs(cloth.triangles, cloth.x); });

    const auto facing =
        std::count_if(pairs.begin(), pairs.end(), [](const NearPair& p) { return p.is_facing; });
    return {cloth.name,
            std::to_string(cloth.x.size()),
            std::to_string(cloth.triangles.size()),
            std::to_string(pairs.size()),
            std::to_string(count),
            std::to_string(facing),
            format("%.2f", build_ms),
            format("%.2f", tree_ms),
            format("%.2f", query_ms)};
}

} // namespace

} // namespace toile::near_pairs

int main(int argc, char** argv)
{
    using namespace toile;
    try {
        const ThreadLimit limit(argc > 1 ? std::atoi(argv[1]) : 1);
        std::vector<Row> rows;
        for (const int vertices : {2500, 10000, 50000})
            for (const near_pairs::Case& cloth : near_pairs::cases(vertices))
                rows.push_back(near_pairs::measure(cloth));
        const Row header{"case",
                         "vertices",
                         "triangles",
                         "pairs",
                         "pairs_by_queries",
                         "facing",
                         "build_edges_and_tree_ms",
                         "find_ms",
                         "point_queries_ms"};
        std::fputs(csv(header, rows).c_str(), stdout);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "near_pairs: %s\n", error.what());
        return 1;
    }
    return 0;
}
