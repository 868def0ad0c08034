/// Prints what the library makes of a glTF file, for gltf_reference.py:
///
///   vertices triangles poses        counts
///   a b c                           corners of every triangle
///   clip time                       of every pose; clip -1 is the file at rest
///   x y z                           of every vertex in it

#include <cstdio>
#include <exception>

#include "avatars/import/gltf_import.h"

namespace {

using namespace toile;
using namespace toile::avatars;

/// The file at rest, and every clip between its keys, at its ends and beyond its end.
std::vector<PoseAt> poses_of(const Avatar& avatar)
{
    std::vector<PoseAt> poses{{}};
    for (size_t clip = 0; clip < avatar.clips().size(); ++clip)
        for (const double fraction : avatar.vertex_count() < 1000
                                         ? std::vector<double>{0.0, 0.21, 0.5, 0.83, 1.0, 1.3}
                                         : std::vector<double>{0.37})
            poses.push_back({int(clip), fraction * avatar.clips()[clip].duration});
    return poses;
}

void print(SkinnedAvatar& avatar)
{
    const std::vector<PoseAt> poses = poses_of(avatar);
    std::printf("%d %zu %zu\n", avatar.vertex_count(), avatar.triangles().size(), poses.size());
    for (const Triangle& t : avatar.triangles())
        std::printf("%d %d %d\n", t[0], t[1], t[2]);
    std::vector<Vec3> x(size_t(avatar.vertex_count()));
    for (const PoseAt& at : poses) {
        std::printf("%d %.17g\n", at.clip, at.time);
        avatar.pose(at, identity_affine(), x);
        for (const Vec3& v : x)
            std::printf("%.9g %.9g %.9g\n", v.x(), v.y(), v.z());
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: gltf_poses FILE\n");
        return 2;
    }
    try {
        SkinnedAvatar avatar(argv[1], import_gltf(argv[1]));
        print(avatar);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
