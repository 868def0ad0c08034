#pragma once

#include <functional>
#include <string>
#include <vector>

#include "research/benchmarks/contact/parts.h"
#include "research/benchmarks/contact/stress_cases.h"
#include "research/benchmarks/power_fit.h"

namespace toile::research::contact_stress {

/// Quantity that grows from case to case of a series.
enum class Series {
    Vertices, ///< at a fixed number of layers
    Layers,   ///< at a fixed number of vertices: contacts grow
};

/// A pile of square sheets with edges of kEdge. The lowest is attached at points a tenth of a metre apart,
/// every second of which is shaken vertically. Every part of a large pile then moves like a small one, and
/// all contact is between cloths.
struct ScalingCase {
    std::string name;
    Series series = Series::Vertices;
    int vertices = 1024; ///< requested, of all sheets; each is square
    int layers = 4;
    int warm_up = 12; ///< steps that are not counted, until the layers lie on each other
    int steps = 16;   ///< counted
};

std::vector<ScalingCase> scaling_cases(Size size);

scenes::Scene scaling_scene(const ScalingCase& trial, int threads);

/// Means per counted step.
struct ScalingResult {
    ScalingCase trial;
    int vertices = 0;
    double contacts = 0.0; ///< active pairs
    double iterations = 0.0;
    double linear_iterations = 0.0;
    PartSeconds parts{}; ///< [s]
};

/// @param after_step  called with the number of steps done; false stops the run
ScalingResult run(const ScalingCase& trial, int threads, const std::function<bool(int)>& after_step);

/// Power laws in vertices and in contacts, for the time of a part or of the whole step.
struct ScalingFit {
    Series series;
    std::string what;     ///< name_of(Part), "step", "contacts" or "iterations"
    PowerFit by_vertices; ///< no fit in Series::Layers, whose vertices are constant
    PowerFit by_contacts;
};

/// Fits for every series with at least two results: the step, its nonzero parts, contacts and iterations.
std::vector<ScalingFit> fit(const std::vector<ScalingResult>& results);

} // namespace toile::research::contact_stress
