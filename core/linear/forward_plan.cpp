#include "core/linear/forward_plan.h"

#include <algorithm>

namespace toile {

namespace {

void append_tiles(int node, int row_count, std::vector<RowTile>& tiles)
{
    for (int first = 0; first < row_count; first += RowTile::kRows)
        tiles.push_back({node, first});
}

} // namespace

LevelTiles tiles_of_columns(const InvertedFactor& factor)
{
    LevelTiles result;
    for (int level = 0; level < factor.level_count(); ++level) {
        result.first.push_back(int(result.tiles.size()));
        for (const int node : factor.level(level))
            append_tiles(node, factor.nodes()[node].width, result.tiles);
    }
    result.first.push_back(int(result.tiles.size()));
    return result;
}

ForwardPlan plan_forward(const InvertedFactor& factor, View<const int> rows)
{
    ForwardPlan plan;
    plan.front_of.assign(factor.nodes().size(), -1);
    std::vector<int> visited;
    for (const int row : rows) {
        if (row < 0)
            continue;
        for (int node = factor.node_of_column(row); node >= 0 && plan.front_of[node] < 0;
             node = factor.nodes()[node].parent) {
            plan.front_of[node] = plan.front_rows;
            plan.front_rows += factor.nodes()[node].height();
            visited.push_back(node);
        }
    }
    std::sort(visited.begin(), visited.end(), [&](int a, int b) {
        const int at_a = factor.level_of(a), at_b = factor.level_of(b);
        return at_a != at_b ? at_a < at_b : a < b;
    });
    for (const int node : visited) {
        plan.tiles.first.resize(factor.level_of(node) + 1, int(plan.tiles.tiles.size()));
        append_tiles(node, factor.nodes()[node].height(), plan.tiles.tiles);
    }
    plan.tiles.first.push_back(int(plan.tiles.tiles.size()));
    return plan;
}

} // namespace toile
