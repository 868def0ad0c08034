#include "export/async_cache_writer.h"

#include "tests/export/export_fixtures.h"

namespace toile::test {

using namespace exports;

namespace {

using ExportExample = ExportTest;

// Shown in docs/guide/caches.md.
TEST_F(ExportExample, WritesACacheAndReadsItBack)
{
    const ObjMesh mesh = quad_mesh();
    const std::filesystem::path out = file("skirt.pc2");

    // [docs]
    CacheLayout layout = cache_layout(mesh, 120);
    layout.fps = 25.0;
    AsyncCacheWriter cache(make_cache_writer(out, layout));
    for (int frame = 0; frame < 120; ++frame)
        cache.write(frame, frame_positions(frame, 7));
    cache.finish();

    const PointCache played = read_cache(out);
    const std::vector<Vec3> last = played.frame(played.frame_count() - 1);
    // [docs]
    EXPECT_EQ(last, frame_positions(119, 7));
}

} // namespace
} // namespace toile::test
