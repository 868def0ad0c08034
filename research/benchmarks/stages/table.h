#pragma once

#include "research/benchmarks/stages/run.h"

namespace toile::research::stages {

/// One line per scene, then one per scene and stage; columns aligned: for terminals and for Markdown.
std::string markdown_tables(const std::vector<Result>& results);

/// One line per scene, comma separated.
std::string csv_of_scenes(const std::vector<Result>& results);

/// One line per scene and stage, comma separated.
std::string csv_of_stages(const std::vector<Result>& results);

} // namespace toile::research::stages
