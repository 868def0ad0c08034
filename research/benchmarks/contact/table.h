#pragma once

#include "research/benchmarks/contact/dressed.h"
#include "research/benchmarks/contact/scaling.h"
#include "research/benchmarks/contact/stress_run.h"

namespace toile::research::contact_stress {

/// Results of a run of the benchmark; groups may be empty.
struct Results {
    std::vector<StressResult> stress;
    std::vector<ScalingResult> scaling;
    std::vector<DressedResult> dressed;
};

/// Tables of all non-empty groups with headings, columns aligned.
std::string markdown_tables(const Results& results);

std::string csv_of_stress(const std::vector<StressResult>& results); ///< a line per case and seed
std::string csv_of_scaling(const std::vector<ScalingResult>& results);
std::string csv_of_exponents(const std::vector<ScalingResult>& results);
std::string csv_of_dressed(const std::vector<DressedResult>& results);

} // namespace toile::research::contact_stress
