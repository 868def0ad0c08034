#pragma once

#include <string>
#include <vector>

#include "benchmarks/gpu/apply.h"
#include "benchmarks/gpu/build_tables.h"
#include "benchmarks/gpu/colliders.h"
#include "benchmarks/gpu/near_pairs.h"
#include "benchmarks/gpu/rivals.h"
#include "benchmarks/gpu/rules.h"
#include "benchmarks/gpu/scene.h"
#include "benchmarks/gpu/step.h"

namespace toile::gpu {

/// What a run measured, and on what.
struct Report {
    CudaDevice device;
    double copy_gbs = 0.0;       ///< [GB/s] read and written, of arrays that no cache holds
    double small_copy_gbs = 0.0; ///< of arrays that the L2 cache holds
    std::vector<Apply> applies;
    std::vector<TableBuild> builds;
    std::vector<Step> steps;
    std::vector<NearSearch> searches;
    std::vector<SceneRun> scenes;
    std::vector<ColliderSearch> colliders;
    std::vector<solvers::Result> rivals;
    std::vector<RuleApply> rules;
};

std::string markdown_tables(const Report& report);
std::string csv_of_applies(const Report& report);
std::string csv_of_steps(const Report& report);

} // namespace toile::gpu
