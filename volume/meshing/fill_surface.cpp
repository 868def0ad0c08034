#include "volume/meshing/fill_surface.h"

#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/odt_optimize_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/mesh/point_text.h"
#include "core/mesh/solid_moments.h"
#include "core/mesh/topology.h"
#include "volume/mesh/short_edges.h"
#include "volume/mesh/slivers.h"

namespace toile::volume {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

/// Angle between faces [degrees] from which an edge is sharp.
constexpr double kSharp = 60.0;

/// Sweeps of smoothing. CGAL's perturbation and exudation would leave better angles, but go through cells in
/// the order of their addresses, so that no two runs agree.
constexpr int kSmoothings = 20;

/// Part of the volume [-] that smoothing may change. In thin parts it loses tetrahedra at the surface.
constexpr double kSmoothed = 0.01;

/// Parts of a surface's volume [-]. Cells of its radius leave kThin of a ball out; with more than that
/// missing, parts are too thin for the cells, and tetrahedra have to have a manifold surface, for which CGAL
/// makes them finer there. No more than kUnfilled may be left out in the end.
constexpr double kThin = 0.15, kUnfilled = 0.35;

/// Length of edges that are collapsed [cells]: where sharp edges of a rough surface zigzag or nearly meet,
/// CGAL makes them as short as need be.
constexpr double kShort = 0.1;

/// Volume of a regular tetrahedron with edges of length 1.
constexpr double kRegularVolume = 0.11785;

/// @param volume  of the surface [m^3]
void require_fillable(const TriangleMesh& surface, double volume, double cell, const std::string& source)
{
    const double tets = volume / (kRegularVolume * cell * cell * cell);
    if (tets > kMaxTets)
        throw InvalidInput(source + ": cells of " + short_text(cell) + " m make about " + short_text(tets) +
                           " tetrahedra, and at most " + short_text(kMaxTets) + " are made; choose " +
                           short_text(std::cbrt(volume / (kRegularVolume * kMaxTets))) + " m or more");
    const Bounds box = bounds(surface.positions);
    const double length = (box.upper - box.lower).maxCoeff();
    if (cell > length)
        throw InvalidInput(source + ": cells of " + short_text(cell) +
                           " m are larger than the surface, which is " + short_text(length) +
                           " m long; four across it are of " + short_text(0.25 * length) + " m");
}

/// @throws InvalidInput for two fans of triangles, each around the same vertex
void require_one_fan_around_vertices(const TriangleMesh& surface, const std::string& source)
{
    const Topology topology = build_topology(surface.triangles, surface.vertex_count(), source);
    DisjointSets fans(3 * surface.triangle_count()); // of corners
    for (const Edge& edge : topology.edges)
        for (const int v : edge.vertex) {
            const auto corner_in = [&](int triangle) {
                const Triangle& t = surface.triangles[triangle];
                return 3 * triangle + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
            };
            fans.join(corner_in(edge.triangle[0]), corner_in(edge.triangle[1]));
        }
    for (int v = 0; v < surface.vertex_count(); ++v)
        for (const int corner : topology.corners_of_vertex.of(v))
            if (fans.find(corner) != fans.find(topology.corners_of_vertex.of(v)[0]))
                throw InvalidInput(source + ": parts of the surface touch in the vertex at " +
                                   point_text(surface.positions[v]) + "; separate them");
}

Polyhedron polyhedron_of(const TriangleMesh& surface, const std::string& source)
{
    namespace processing = CGAL::Polygon_mesh_processing;
    require_one_fan_around_vertices(surface, source);
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> faces;
    for (const Vec3& x : surface.positions)
        points.emplace_back(x.x(), x.y(), x.z());
    for (const Triangle& t : surface.triangles)
        faces.push_back({std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])});
    Polyhedron polyhedron;
    processing::polygon_soup_to_polygon_mesh(points, faces, polyhedron);
    using Face = Polyhedron::Facet_handle;
    std::vector<std::pair<Face, Face>> crossings;
    processing::self_intersections(polyhedron, std::back_inserter(crossings),
                                   CGAL::parameters::maximum_number(1));
    if (!crossings.empty()) {
        const Kernel::Point_3& near = crossings.front().first->halfedge()->vertex()->point();
        throw InvalidInput(source + ": the surface crosses itself near " +
                           point_text({near.x(), near.y(), near.z()}) +
                           "; a body can't be filled that has no clear inside");
    }
    return polyhedron;
}

TetMesh mesh_of(const Complex& complex)
{
    TetMesh mesh;
    std::map<Triangulation::Vertex_handle, int> number;
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
        Tet tet;
        for (int k = 0; k < 4; ++k) {
            const auto [at, is_new] = number.try_emplace(cell->vertex(k), mesh.vertex_count());
            if (is_new) {
                const auto& x = cell->vertex(k)->point();
                mesh.positions.emplace_back(CGAL::to_double(x.x()), CGAL::to_double(x.y()),
                                            CGAL::to_double(x.z()));
            }
            tet[k] = at->second;
        }
        mesh.tets.push_back(tet);
    }
    return mesh;
}

double total_volume(const TetMesh& mesh)
{
    return std::accumulate(mesh.tets.begin(), mesh.tets.end(), 0.0, [&](double sum, const Tet& tet) {
        return sum + std::fabs(volume_of(tet, mesh.positions));
    });
}

/// Tetrahedra with vertices moved to where their shapes are better, or as they are if that changes the
/// volume.
TetMesh smoothed(Complex& complex, const Domain& domain)
{
    TetMesh mesh = mesh_of(complex);
    CGAL::odt_optimize_mesh_3(complex, domain, CGAL::parameters::max_iteration_number = kSmoothings);
    TetMesh smooth = mesh_of(complex);
    const double volume = total_volume(mesh);
    return std::fabs(total_volume(smooth) - volume) <= kSmoothed * volume ? smooth : mesh;
}

/// @param volume  of the surface [m^3]
TetMesh tets_in(const Domain& domain, double cell, double volume)
{
    // Sizes bound the radii of circles and spheres around triangles and tetrahedra.
    namespace parameters = CGAL::parameters;
    constexpr double kTriangle = 0.6, kTetrahedron = 0.65, kDistance = 0.1; // of an edge
    const Criteria criteria(
        parameters::edge_size = cell, parameters::facet_angle = 25.0,
        parameters::facet_size = kTriangle * cell, parameters::facet_distance = kDistance * cell,
        parameters::cell_radius_edge_ratio = 2.0, parameters::cell_size = kTetrahedron * cell);
    Complex complex =
        CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_odt(), parameters::no_lloyd(),
                                   parameters::no_perturb(), parameters::no_exude());
    if (total_volume(mesh_of(complex)) < (1.0 - kThin) * volume)
        CGAL::refine_mesh_3(complex, domain, criteria, parameters::no_odt(), parameters::no_lloyd(),
                            parameters::no_perturb(), parameters::no_exude(), parameters::manifold());
    return smoothed(complex, domain);
}

} // namespace

TetMesh fill_surface(const TriangleMesh& surface, double cell, const std::string& source)
{
    const double volume = solid_moments(surface, source).volume;
    require_fillable(surface, volume, cell, source);
    CGAL::get_default_random() = CGAL::Random(0);
    Polyhedron polyhedron = polyhedron_of(surface, source);
    Domain domain(polyhedron, &CGAL::get_default_random());
    domain.detect_features(kSharp);

    const std::string cells = source + ": cells of " + short_text(cell) + " m ";
    TetMesh mesh;
    try {
        mesh = tets_in(domain, cell, volume);
    } catch (const CGAL::Failure_exception& error) {
        throw InvalidInput(
            cells + "do not fit the surface; try smaller or larger ones (CGAL: " + error.message() + ")");
    }
    const double unfilled = 1.0 - total_volume(mesh) / volume;
    if (unfilled > kUnfilled)
        throw InvalidInput(cells + "leave " + short_text(100.0 * unfilled) +
                           " % of its volume out; choose smaller ones");
    orient(
        mesh, [](int t) { return "tetrahedron " + std::to_string(t); }, source);
    collapse_short_edges(mesh, kShort * cell);
    improve_slivers(mesh);
    return mesh;
}

} // namespace toile::volume
