#include "garment/pattern/sewn_sides.h"

#include <algorithm>

#include "garment/pattern/edge_curve.h"

namespace toile::garment {
namespace {

/// Two panels that a seam joins.
struct Link {
    int panel_a;
    int panel_b;
    int seam;
    bool swaps; ///< the outer side of one continues as the inner side of the other
};

bool runs_forward(const EdgePart& part) { return part.to >= part.from; }

/// Every pair of panels along the seams' sides. Chains make several links. Cloth goes on at both sides of a
/// line inside of a panel: what is sewn there has either side out.
std::vector<Link> links_of(const Pattern& pattern)
{
    std::vector<Link> links;
    for (size_t s = 0; s < pattern.seams.size(); ++s)
        for (const EdgePart& a : pattern.seams[s].a)
            for (const EdgePart& b : pattern.seams[s].b)
                if (!is_on_line(pattern, a) && !is_on_line(pattern, b))
                    links.push_back({a.panel, b.panel, int(s), runs_forward(a) == runs_forward(b)});
    return links;
}

/// Whether a link joins sides that do not belong together.
bool is_violated(const Link& link, const std::vector<bool>& turned)
{
    return (turned[size_t(link.panel_a)] != turned[size_t(link.panel_b)]) != link.swaps;
}

/// Turns panels so that every link is obeyed, if that can be: spreads over each connected piece from its
/// first panel.
std::vector<bool> spread(size_t panel_count, const std::vector<Link>& links)
{
    std::vector<bool> turned(panel_count, false);
    std::vector<bool> reached(panel_count, false);
    for (size_t first = 0; first < panel_count; ++first) {
        if (reached[first])
            continue;
        reached[first] = true;
        for (bool grown = true; grown;) {
            grown = false;
            for (const Link& link : links) {
                const auto a = size_t(link.panel_a);
                const auto b = size_t(link.panel_b);
                if (reached[a] == reached[b])
                    continue;
                turned[reached[a] ? b : a] = turned[reached[a] ? a : b] != link.swaps;
                reached[a] = reached[b] = grown = true;
            }
        }
    }
    return turned;
}

int violated_at(int panel, const std::vector<Link>& links, const std::vector<bool>& turned)
{
    return int(std::count_if(links.begin(), links.end(), [&](const Link& link) {
        return link.panel_a != link.panel_b && (link.panel_a == panel || link.panel_b == panel) &&
               is_violated(link, turned);
    }));
}

/// Turns single panels while that leaves fewer violated links.
std::vector<bool> descend(size_t panel_count, const std::vector<Link>& links)
{
    std::vector<bool> turned(panel_count, false);
    for (bool improved = true; improved;) {
        improved = false;
        for (size_t panel = 0; panel < panel_count; ++panel) {
            const int before = violated_at(int(panel), links, turned);
            turned[panel] = !turned[panel];
            if (violated_at(int(panel), links, turned) < before)
                improved = true;
            else
                turned[panel] = !turned[panel];
        }
    }
    return turned;
}

/// Turns over the pieces of which more panels are turned than not, so that few are.
void prefer_few_turned(std::vector<bool>& turned, const std::vector<Link>& links)
{
    std::vector<int> piece(turned.size());
    for (size_t i = 0; i < piece.size(); ++i)
        piece[i] = int(i);
    for (bool merged = true; merged;) {
        merged = false;
        for (const Link& link : links) {
            int& a = piece[size_t(link.panel_a)];
            int& b = piece[size_t(link.panel_b)];
            merged = merged || a != b;
            a = b = std::min(a, b);
        }
    }
    std::vector<int> balance(turned.size(), 0);
    for (size_t i = 0; i < turned.size(); ++i)
        balance[size_t(piece[i])] += turned[i] ? 1 : -1;
    for (size_t i = 0; i < turned.size(); ++i)
        if (balance[size_t(piece[i])] > 0)
            turned[i] = !turned[i];
}

} // namespace

SewnSides sewn_sides(const Pattern& pattern)
{
    const std::vector<Link> links = links_of(pattern);
    SewnSides sides;
    sides.turned = spread(pattern.panels.size(), links);
    const auto violated = [&](const Link& link) { return is_violated(link, sides.turned); };
    if (std::none_of(links.begin(), links.end(), violated)) {
        prefer_few_turned(sides.turned, links);
        return sides;
    }
    sides.turned = descend(pattern.panels.size(), links);
    for (const Link& link : links)
        if (violated(link) && (sides.one_sided.empty() || sides.one_sided.back() != link.seam))
            sides.one_sided.push_back(link.seam);
    return sides;
}

} // namespace toile::garment
