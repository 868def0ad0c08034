#pragma once

#include <string>
#include <vector>

#include "research/benchmarks/gpu/apply.h"
#include "research/benchmarks/gpu/baselines.h"
#include "research/benchmarks/gpu/build_tables.h"
#include "research/benchmarks/gpu/colliders.h"
#include "research/benchmarks/gpu/near_pairs.h"
#include "research/benchmarks/gpu/rules.h"
#include "research/benchmarks/gpu/scene.h"
#include "research/benchmarks/gpu/step.h"

namespace toile::research::gpu {

/// Results of a run, and its device.
struct Report {
    CudaDevice device;
    double copy_gbs = 0.0;       ///< [GB/s] read and written, of arrays larger than any cache
    double small_copy_gbs = 0.0; ///< [GB/s] of arrays that fit the L2 cache
    std::vector<Apply> applies;
    std::vector<TableBuild> builds;
    std::vector<Step> steps;
    std::vector<NearSearch> searches;
    std::vector<SceneRun> scenes;
    std::vector<ColliderSearch> colliders;
    std::vector<solvers::Result> baselines;
    std::vector<RuleApply> rules;
};

std::string markdown_tables(const Report& report);
std::string csv_of_applies(const Report& report);
std::string csv_of_steps(const Report& report);

} // namespace toile::research::gpu
