#include "scenes/drape/garment_folds.h"

#include <array>

namespace toile::scenes {

namespace {

/// Neighbours of outline vertices along their loop. [vertices]; -1 inside
struct Outline {
    std::vector<int> next, previous;

    explicit Outline(const garment::PatternMesh& mesh) : next(size_t(mesh.vertex_count()), -1), previous(next)
    {
        for (const auto& panel : mesh.edge_vertices)
            for (const auto& edge : panel)
                for (size_t i = 0; i + 1 < edge.size(); ++i) {
                    next[edge[i].vertex] = edge[i + 1].vertex;
                    previous[edge[i + 1].vertex] = edge[i].vertex;
                }
    }

    bool are_neighbours(int a, int b) const { return next[a] == b || previous[a] == b; }

    /// Vertex beside both, at which a dart ends; -1: there is none.
    int tip_between(int a, int b) const
    {
        for (const int tip : {next[a], previous[a]})
            if (tip >= 0 && tip != b && are_neighbours(tip, b))
                return tip;
        return -1;
    }
};

/// Pairs of vertices that one seam welds, in its order, with the tips of darts at its ends.
std::vector<std::array<int, 2>> welded_pairs(const std::vector<std::array<int, 2>>& seam,
                                             const Outline& outline, const garment::SewnMesh& partly)
{
    std::vector<std::array<int, 2>> pairs;
    const auto add_tip = [&](const std::array<int, 2>& end) {
        if (const int tip = outline.tip_between(end[0], end[1]); tip >= 0)
            pairs.push_back({tip, tip});
    };
    if (seam.empty())
        return pairs;
    add_tip(seam.front());
    pairs.insert(pairs.end(), seam.begin(), seam.end());
    if (seam.size() > 1)
        add_tip(seam.back());
    std::erase_if(pairs,
                  [&](const auto& pair) { return partly.welded_of[pair[0]] != partly.welded_of[pair[1]]; });
    return pairs;
}

} // namespace

GarmentFolds::GarmentFolds(const garment::Pattern& pattern) : panels(pattern.folds)
{
    for (const garment::Seam& seam : pattern.seams)
        seam_angle_deg.push_back(seam.fold_deg);
}

std::vector<scene::Fold> GarmentFolds::on(const garment::PatternMesh& mesh,
                                          const garment::SewnMesh& partly) const
{
    std::vector<scene::Fold> folds;
    const auto sign_of = [&](int panel) { return partly.is_turned[size_t(panel)] ? -1.0 : 1.0; };
    for (size_t f = 0; f < panels.size(); ++f) {
        scene::Fold fold{{}, sign_of(panels[f].panel) * panels[f].angle_deg, panels[f].stiffness};
        for (const int v : mesh.fold_vertices[f])
            fold.vertices.push_back(partly.welded_of[v]);
        folds.push_back(std::move(fold));
    }

    // One fold for each edge of a seam that is folded.
    const Outline outline(mesh);
    for (size_t s = 0; s < seam_angle_deg.size(); ++s) {
        if (seam_angle_deg[s] == 0.0)
            continue;
        const auto pairs = welded_pairs(mesh.stitches[s], outline, partly);
        for (size_t i = 0; i + 1 < pairs.size(); ++i) {
            const auto &low = pairs[i], &high = pairs[i + 1];
            if (!outline.are_neighbours(low[0], high[0]) || !outline.are_neighbours(low[1], high[1]))
                continue;
            scene::Fold fold;
            fold.vertices = {partly.welded_of[low[0]], partly.welded_of[high[0]]};
            fold.angle_deg = sign_of(mesh.panel_of_vertex(low[0])) * seam_angle_deg[s];
            folds.push_back(std::move(fold));
        }
    }
    return folds;
}

} // namespace toile::scenes
