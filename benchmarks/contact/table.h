#pragma once

#include "benchmarks/contact/dressed.h"
#include "benchmarks/contact/scaling.h"
#include "benchmarks/contact/stress_run.h"

namespace toile::contact {

/// What a run of the benchmark found; groups may be empty.
struct Results {
    std::vector<StressResult> stress;
    std::vector<ScalingResult> scaling;
    std::vector<DressedResult> dressed;
};

/// Tables of all groups that are not empty, with a heading each; columns aligned.
std::string markdown_tables(const Results& results);

std::string csv_of_stress(const std::vector<StressResult>& results); ///< a line per case and seed
std::string csv_of_scaling(const std::vector<ScalingResult>& results);
std::string csv_of_exponents(const std::vector<ScalingResult>& results);
std::string csv_of_dressed(const std::vector<DressedResult>& results);

} // namespace toile::contact
