#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/contact/parts.h"
#include "benchmarks/contact/power_fit.h"
#include "benchmarks/contact/stress_cases.h"

namespace toile::contact {

/// What grows from case to case of a series.
enum class Series {
    Vertices, ///< at a fixed number of layers
    Layers,   ///< at a fixed number of vertices: contacts
};

/// A pile of square sheets with edges of kEdge. The lowest is held at points a tenth of a metre apart, every
/// other of which shakes up and down: every part of a large pile sees what all of a small one does, and cloth
/// alone is touched.
struct ScalingCase {
    std::string name;
    Series series = Series::Vertices;
    int vertices = 1024; ///< wanted, of all sheets; each is square
    int layers = 4;
    int warm_up = 12; ///< steps that are not counted: layers come to lie on each other
    int steps = 16;   ///< counted
};

std::vector<ScalingCase> scaling_cases(Size size);

Scene scaling_scene(const ScalingCase& trial, int threads);

/// Means per counted step.
struct ScalingResult {
    ScalingCase trial;
    int vertices = 0;
    double contacts = 0.0; ///< pairs that push
    double iterations = 0.0;
    double linear_iterations = 0.0;
    PartSeconds parts{}; ///< [s]
};

/// @param after_step  called with the number of steps done; false breaks the run off
ScalingResult run(const ScalingCase& trial, int threads, const std::function<bool(int)>& after_step);

/// A power of vertices and one of contacts, for the time of a part or of the whole step.
struct ScalingFit {
    Series series;
    std::string what;     ///< name_of(Part), "step", "contacts" or "iterations"
    PowerFit by_vertices; ///< without points in Series::Layers, whose vertices are all the same
    PowerFit by_contacts;
};

/// For every series with at least two results: the step, its parts that take time, contacts and iterations.
std::vector<ScalingFit> fit(const std::vector<ScalingResult>& results);

} // namespace toile::contact
