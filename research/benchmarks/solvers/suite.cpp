#include "research/benchmarks/solvers/suite.h"

#include <charconv>

#include "core/base/error.h"

namespace toile::research::solvers {

namespace {

constexpr double kFrame = 1.0 / 120.0;
constexpr int kMinVertices = 50;
constexpr int kMaxVertices = 200'000;

struct Mesh {
    const char* name;
    Problem (*make)(int vertices, double stiffness, double dt);
    double stiffness; ///< [N/m]; [Pa] of a solid
};
constexpr Mesh kMeshes[] = {{"sheet", &Problem::sheet, 1e3},
                            {"skirt", &Problem::skirt, 1e3},
                            {"drape", &Problem::drape, 1e3},
                            {"bar", &Problem::bar, 2e5}};

/// Sampling of a problem. The last sample is step 32 for every size: two of a large cloth, four of a small
/// one.
Case sampled(Problem problem)
{
    const bool is_large = problem.vertex_count() > 6000;
    return {std::move(problem), is_large ? 2 : 4, is_large ? 16 : 8};
}

std::vector<Case> quick_cases()
{
    std::vector<Case> cases;
    for (const Mesh& mesh : kMeshes)
        cases.push_back({mesh.make(900, mesh.stiffness, kFrame), 2, 8});
    return cases;
}

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    const auto add = [&](const Problem& problem) { cases.push_back(sampled(problem)); };
    for (const int vertices : {1000, 2500, 10'000})
        for (const double stiffness : {1e2, 1e3, 1e4})
            add(Problem::sheet(vertices, stiffness, kFrame));
    for (const int vertices : {2500, 10'000})
        for (const double dt : {1.0 / 60.0, 1.0 / 30.0})
            add(Problem::sheet(vertices, 1e3, dt));
    add(Problem::skirt(5000, 1e3, kFrame));
    for (const int vertices : {1000, 2500, 10'000})
        add(Problem::drape(vertices, 1e3, kFrame));
    for (const int vertices : {1000, 4000})
        for (const double young : {2e4, 2e5, 2e6})
            add(Problem::bar(vertices, young, kFrame));
    add(Problem::sheet(50'000, 1e2, kFrame));
    add(Problem::sheet(50'000, 1e3, kFrame));
    return cases;
}

int vertices_of(const std::string& text)
{
    int vertices = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), vertices);
    if (error != std::errc() || end != text.data() + text.size() || vertices < kMinVertices ||
        vertices > kMaxVertices)
        throw InvalidInput("--mesh: \"" + text + "\" vertices; must be a whole number from " +
                           std::to_string(kMinVertices) + " to " + std::to_string(kMaxVertices));
    return vertices;
}

const Mesh& mesh_named(const std::string& name)
{
    for (const Mesh& mesh : kMeshes)
        if (name == mesh.name)
            return mesh;
    throw InvalidInput("--mesh: no mesh \"" + name + "\"; must be sheet, skirt, drape or bar");
}

} // namespace

std::vector<Case> choose_cases(const std::string& mesh, bool quick)
{
    if (mesh.empty())
        return quick ? quick_cases() : all_cases();

    const size_t colon = mesh.find(':');
    const Mesh& chosen = mesh_named(mesh.substr(0, colon));
    if (colon != std::string::npos)
        return {sampled(chosen.make(vertices_of(mesh.substr(colon + 1)), chosen.stiffness, kFrame))};

    std::vector<Case> cases = quick ? quick_cases() : all_cases();
    std::erase_if(cases, [&](const Case& c) { return c.problem.mesh != chosen.name; });
    return cases;
}

std::vector<Method> choose_methods(const std::string& only)
{
    std::vector<Method> methods = all_methods();
    std::erase_if(methods, [&](const Method& method) { return method.name.find(only) == std::string::npos; });
    if (methods.empty())
        throw InvalidInput("--only: no method of solvers has \"" + only +
                           "\" in its name; see docs/journal/solvers.md for the names");
    return methods;
}

} // namespace toile::research::solvers
