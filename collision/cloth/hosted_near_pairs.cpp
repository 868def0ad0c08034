#include "collision/cloth/hosted_near_pairs.h"

#include "core/backend/stages.h"

namespace toile {

HostedNearPairs::HostedNearPairs(const CudaSpace& space, View<const Triangle> triangles,
                                 View<const Vec3> positions, View<const int> rigid)
    : there_(space, triangles, positions, rigid), x_(space, "near_pairs/x"),
      motion_(space, "near_pairs/motion"), slack_(space, "near_pairs/slack"),
      around_(space, "near_pairs/around")
{
}

void HostedNearPairs::find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out)
{
    const StageScope stage("collision/cloth_pairs_there");
    x_.upload(x);
    motion_.upload(ways.motion);
    slack_.upload(ways.slack);
    around_.upload(ways.around);
    out.resize(there_.find(x_.view(), {motion_.view(), slack_.view(), around_.view()}, margin).size());
    there_.download(out);
}

} // namespace toile
