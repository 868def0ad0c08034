#include <gtest/gtest.h>

#include <algorithm>

#include "research/benchmarks/gpu/scene.h"

namespace toile::research::gpu {
namespace {

SceneRun runway()
{
    SceneRun run;
    run.name = "runway";
    run.backend = "cuda";
    run.vertices = 241357;
    run.frames = 60;
    run.steps = 60;
    run.dt = 1.0 / 60.0;
    run.iterations = 41.6;
    run.cull_ms = 3.25;
    run.total_ms = 100.0;
    run.max_strain = 0.061;
    return run;
}

TEST(GpuScenes, HaveRowsOfCostAndOutcome)
{
    const std::string tables = markdown_of({runway()});
    EXPECT_EQ(std::count(tables.begin(), tables.end(), '\n'), 3 + 1 + 3);
    EXPECT_NE(tables.find("| 1/60 "), std::string::npos) << tables;
    EXPECT_NE(tables.find("| 42 "), std::string::npos) << tables;
    EXPECT_EQ(
        csv_of({runway()}),
        "scene,backend,vertices,dt,frames,iterations,pcg,contacts,cull_ms,narrow_ms,local_global_ms,limits_"
        "ms,step_ms,slowest_ms,load_s,prepare_s,settle_s,gpu_gb,crossings_before,crossings,strain_percent,"
        "frames_at_limit\n"
        "runway,cuda,241357,1/60,60,42,0,0,3.2,0.0,0.0,0.0,100.0,0.0,0.0,0.0,0.0,0.00,0,0,6.1,0\n");
}

TEST(GpuScenes, AreSkippedWithAMessage)
{
    SceneRun dance;
    dance.name = "dance";
    dance.skipped = "there is no data";
    EXPECT_NE(markdown_of({runway(), dance}).find("SKIPPED: scene dance: there is no data\n"),
              std::string::npos);
    EXPECT_EQ(csv_of({runway(), dance}), csv_of({runway()}));
}

} // namespace
} // namespace toile::research::gpu
