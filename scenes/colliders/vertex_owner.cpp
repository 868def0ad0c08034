#include "scenes/colliders/vertex_owner.h"

#include <algorithm>
#include <iterator>

#include "core/base/error.h"

namespace toile::scenes {

VertexOwner owner_of(const AttachmentConstraint& attachment)
{
    return {attachment.location(), attachment.vertices(), attachment.is_at_rest()};
}

void require_one_owner(const std::vector<VertexOwner>& owners, const std::string& object,
                       const std::function<std::string(int vertex)>& name_of)
{
    for (size_t b = 1; b < owners.size(); ++b)
        for (size_t a = 0; a < b; ++a) {
            if (owners[a].is_at_rest && owners[b].is_at_rest)
                continue;
            const View<const int> first = owners[a].vertices, second = owners[b].vertices;
            std::vector<int> shared;
            std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                                  std::back_inserter(shared));
            if (shared.empty())
                continue;
            throw InvalidInput(
                owners[b].location + ": selects " + name_of(shared[0]) + " of \"" + object + "\"" +
                (shared.size() == 1 ? "" : " and " + std::to_string(shared.size() - 1) + " more") +
                ", which " + owners[a].location + " holds already; a vertex can follow one of them only");
        }
}

} // namespace toile::scenes
