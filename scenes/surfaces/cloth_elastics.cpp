#include "scenes/surfaces/cloth_elastics.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/base/error.h"

namespace toile::scenes {

namespace {

const std::string kRemedy = "name vertices of the surface";

/// Lengths of the edges of a cloth at rest, by their vertices in ascending order. [m]
class EdgeLengths {
public:
    explicit EdgeLengths(const garment::RestShape& rest)
    {
        for (size_t t = 0; t < rest.triangles.size(); ++t) {
            const Triangle& corner = rest.triangles[t];
            const Mat2& edges = rest.edges[t];
            add(corner[0], corner[1], edges.col(0).norm());
            add(corner[0], corner[2], edges.col(1).norm());
            add(corner[1], corner[2], (edges.col(1) - edges.col(0)).norm());
        }
    }

    /// Mean over the triangles of an edge; 0 if there is no such edge.
    double operator()(int a, int b) const
    {
        const auto sum = sums_.find({std::min(a, b), std::max(a, b)});
        return sum == sums_.end() ? 0.0 : sum->second.length / sum->second.count;
    }

private:
    struct Sum {
        double length = 0.0;
        int count = 0;
    };

    void add(int a, int b, double length)
    {
        Sum& sum = sums_[{std::min(a, b), std::max(a, b)}];
        sum.length += length;
        ++sum.count;
    }

    std::map<std::array<int, 2>, Sum> sums_;
};

} // namespace

std::vector<garment::Elastics::Spring> elastic_springs(const std::vector<scene::Elastic>& elastics,
                                                       const ClothState& cloth,
                                                       const garment::RestShape& rest,
                                                       const std::string& key_path)
{
    if (elastics.empty())
        return {};
    const EdgeLengths lengths(rest);
    std::vector<garment::Elastics::Spring> springs;
    for (size_t i = 0; i < elastics.size(); ++i) {
        const scene::Elastic& elastic = elastics[i];
        const std::string location = key_path + "[" + std::to_string(i) + "].vertices";
        for (size_t k = 0; k + 1 < elastic.vertices.size(); ++k) {
            const int a = cloth.vertex_of_file(elastic.vertices[k], location, kRemedy),
                      b = cloth.vertex_of_file(elastic.vertices[k + 1], location, kRemedy);
            const double length = lengths(a, b);
            if (!(length > 0.0))
                throw InvalidInput(location + ": vertices " + std::to_string(elastic.vertices[k]) + " and " +
                                   std::to_string(elastic.vertices[k + 1]) + " of \"" + cloth.name +
                                   "\" share no edge; name those along edges of the mesh, in order");
            springs.push_back({a, b, elastic.ratio * length, elastic.stiffness});
        }
    }
    return springs;
}

} // namespace toile::scenes
