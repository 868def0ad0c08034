#include "core/pd/newton/connected_groups.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace toile {

namespace {

/// Items that links reach from `start` through items that `admits` admits: each at most once.
template <typename Admits>
std::vector<int> reached(const Links& links, int start, const Admits& admits)
{
    std::vector<int> found{start};
    for (size_t k = 0; k < found.size(); ++k)
        for (const int j : links.of(found[k]))
            if (admits(j))
                found.push_back(j);
    std::sort(found.begin(), found.end());
    return found;
}

/// A group while small ones are joined.
struct Growing {
    int label;
    std::vector<int> items;
    int weight;
};

/// Connected items of one label, in several pieces where they are too heavy for one.
std::vector<Growing> pieces_of(const Links& links, View<const int> labels, View<const int> weights,
                               int largest, std::vector<int>& piece_of)
{
    std::vector<Growing> pieces;
    for (int start = 0; start < links.count(); ++start) {
        if (labels[start] < 0 || piece_of[start] >= 0)
            continue;
        const int piece = int(pieces.size());
        piece_of[start] = piece;
        int weight = weights[start];
        std::vector<int> items = reached(links, start, [&](int j) {
            if (labels[j] != labels[start] || piece_of[j] >= 0 || weight + weights[j] > largest)
                return false;
            piece_of[j] = piece;
            weight += weights[j];
            return true;
        });
        pieces.push_back({labels[start], std::move(items), weight});
    }
    return pieces;
}

/// Group with most links to another, of those that it may join; -1: none.
int closest_to(const Links& links, const std::vector<Growing>& groups, const std::vector<int>& group_of,
               int group, int largest)
{
    std::vector<int> linked;
    for (const int i : groups[group].items)
        for (const int j : links.of(i))
            if (const int other = group_of[j];
                other >= 0 && other != group && groups[other].weight + groups[group].weight <= largest)
                linked.push_back(other);
    std::sort(linked.begin(), linked.end());
    int closest = -1;
    std::ptrdiff_t most = 0;
    for (auto run = linked.begin(); run != linked.end();) {
        const auto end = std::upper_bound(run, linked.end(), *run);
        if (end - run > most) {
            most = end - run;
            closest = *run;
        }
        run = end;
    }
    return closest;
}

} // namespace

Links links_of(const BlockMatrix& blocks, const SparseMatrix& isotropic, View<const unsigned char> excluded)
{
    Links links;
    for (int i = 0; i < excluded.size(); ++i) {
        const auto add = [&](int j) {
            if (j != i && !excluded[j])
                links.to.push_back(j);
        };
        if (!excluded[i]) {
            for (const int j : blocks.columns(i))
                add(j);
            for (SparseMatrix::InnerIterator entry(isotropic, i); entry; ++entry)
                add(int(entry.col()));
        }
        links.first.push_back(int(links.to.size()));
    }
    return links;
}

std::vector<std::vector<int>> connected_components(const Links& links, View<const unsigned char> excluded)
{
    std::vector<unsigned char> seen(excluded.begin(), excluded.end());
    std::vector<std::vector<int>> components;
    for (int start = 0; start < links.count(); ++start)
        if (!std::exchange(seen[start], 1))
            components.push_back(reached(links, start, [&](int j) { return !std::exchange(seen[j], 1); }));
    return components;
}

Groups connected_groups(const Links& links, View<const int> labels, View<const int> weights, int smallest,
                        int largest)
{
    std::vector<int> group_of(links.count(), -1);
    std::vector<Growing> groups = pieces_of(links, labels, weights, largest, group_of);

    std::vector<int> order(groups.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return groups[a].weight < groups[b].weight; });
    for (const int small : order) {
        if (groups[small].weight >= smallest)
            continue;
        const int closest = closest_to(links, groups, group_of, small, largest);
        if (closest < 0)
            continue;
        for (const int i : groups[small].items)
            group_of[i] = closest;
        std::vector<int>& items = groups[closest].items;
        items.insert(items.end(), groups[small].items.begin(), groups[small].items.end());
        groups[closest].weight += groups[small].weight;
        groups[small].items.clear();
    }

    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return groups[a].label < groups[b].label; });
    Groups result{std::vector<int>(links.count(), -1), {}};
    for (const int g : order) {
        if (groups[g].items.empty())
            continue;
        for (const int i : groups[g].items)
            result.of[i] = result.count();
        result.label.push_back(groups[g].label);
    }
    return result;
}

Groups joined_groups(const Links& links, const Groups& groups, View<const int> weights, int count,
                     int largest)
{
    const Links between = links_between(links, groups);
    std::vector<std::map<int, int>> linked(groups.count()); // how often with each other group
    for (int g = 0; g < groups.count(); ++g)
        for (const int other : between.of(g))
            ++linked[g][other];
    std::vector<int> weight = sums_of(groups, weights);
    std::set<std::pair<int, int>> by_weight;
    for (int g = 0; g < groups.count(); ++g)
        by_weight.emplace(weight[g], g);

    std::vector<int> joins(groups.count(), -1);
    for (int left = groups.count(); left > count && !by_weight.empty();) {
        const int g = by_weight.begin()->second;
        by_weight.erase(by_weight.begin());
        int to = -1;
        for (const auto& [other, times] : linked[g])
            if (weight[g] + weight[other] <= largest &&
                (to < 0 || double(times) / weight[other] > double(linked[g][to]) / weight[to]))
                to = other;
        if (to < 0)
            continue;
        for (const auto& [other, times] : linked[g]) {
            linked[other].erase(g);
            if (other != to) {
                linked[other][to] += times;
                linked[to][other] += times;
            }
        }
        by_weight.erase({weight[to], to});
        weight[to] += weight[g];
        by_weight.emplace(weight[to], to);
        joins[g] = to;
        --left;
    }

    Groups result{groups.of, {}};
    std::vector<int> number(groups.count(), -1);
    for (int g = 0; g < groups.count(); ++g)
        if (joins[g] < 0) {
            number[g] = result.count();
            result.label.push_back(groups.label[g]);
        }
    for (int& g : result.of) {
        while (g >= 0 && joins[g] >= 0)
            g = joins[g];
        g = g < 0 ? -1 : number[g];
    }
    return result;
}

Links links_between(const Links& links, const Groups& groups)
{
    std::vector<std::vector<int>> to(groups.count());
    for (int i = 0; i < links.count(); ++i)
        for (const int j : links.of(i))
            if (const int g = groups.of[i], h = groups.of[j]; g >= 0 && h >= 0 && g != h)
                to[g].push_back(h);
    Links result;
    for (const std::vector<int>& others : to) {
        result.to.insert(result.to.end(), others.begin(), others.end());
        result.first.push_back(int(result.to.size()));
    }
    return result;
}

std::vector<int> sums_of(const Groups& groups, View<const int> numbers)
{
    std::vector<int> sums(groups.count(), 0);
    for (int i = 0; i < numbers.size(); ++i)
        if (groups.of[i] >= 0)
            sums[groups.of[i]] += numbers[i];
    return sums;
}

} // namespace toile
