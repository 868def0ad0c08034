#include "scenes/world/scene_costs.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/hash.h"
#include "core/compute/parallel.h"
#include "core/quadrature/expected_tables.h"
#include "scenes/format/solver_methods.h"
#include "scenes/world/cloth_group.h"

namespace toile::scenes {

namespace {

/// Memory of a GPU for a vertex without tables [bytes], rounded outwards from what was measured: 7.2 to 12 kB
/// of cloth and 6.1 to 20 kB of soft bodies, tables included.
struct BytesOfVertex {
    std::size_t min, max;
};
constexpr BytesOfVertex kCloth{5'500, 13'500}, kBody{5'000, 21'000};

/// Other data of a scene with contact [bytes].
constexpr std::size_t kBytesOfScene = std::size_t(64) << 20;

constexpr double kKilo = 1e3;

std::string in_mebibytes(std::size_t bytes) { return std::to_string(bytes >> 20); }

/// Adds up the tables of different parts.
class TableSum {
public:
    TableSum(const Scene& scene, bool on_gpu, SceneCosts& costs)
        : scene_(scene), on_gpu_(on_gpu), threads_(thread_count(kCpu)), costs_(costs)
    {
    }

    /// @param key  of shape and material; completed here
    void add(Hasher& key, const std::string& name, bool has_core, Extent extent, int vertices)
    {
        key.add(int(extent));
        if (has_core || is_attached(name))
            key.add(costs_.parts);
        ++costs_.parts;
        if (vertices == 0 || is_baseline(scene_.solver.method) || !known_.insert(key.result()).second)
            return;
        const ExpectedTables tables =
            on_gpu_ ? expected_tables_on_gpu(vertices, extent) : expected_tables(vertices, extent, threads_);
        ++costs_.tables;
        costs_.table_seconds += tables.seconds;
        costs_.table_bytes += tables.bytes;
    }

private:
    bool is_attached(const std::string& name) const
    {
        return std::any_of(scene_.attachments.begin(), scene_.attachments.end(),
                           [&](const scene::Attachment& attachment) { return attachment.cloth == name; });
    }

    const Scene& scene_;
    bool on_gpu_;
    int threads_;
    std::set<Hash128> known_;
    SceneCosts& costs_;
};

void add_cloths(const Scene& scene, const std::vector<SceneCloth>& cloths, TableSum& tables,
                SceneCosts& costs)
{
    for (size_t i = 0; i < cloths.size(); ++i) {
        const SceneCloth& cloth = cloths[i];
        Hasher key;
        key.add(View<const Triangle>(cloth.rest_shape()->triangles));
        key.add(View<const Mat2>(cloth.rest_shape()->edges));
        key.add(View<const double>(cloth.masses()));
        key.add(std::string_view(scene.cloths[i].fabric));
        tables.add(key, cloth.state().name, false, Extent::Surface, cloth.vertex_count());
        costs.cloth_vertices += cloth.vertex_count();
    }
}

void add_bodies(const Scene& scene, const SceneSoftBodies& bodies, TableSum& tables, SceneCosts& costs)
{
    for (int i = 0; i < bodies.count(); ++i) {
        const scene::SoftBody& settings = scene.soft_bodies[i];
        const std::vector<Vec3>& rest = bodies.rest_positions(i);
        Hasher key;
        key.add(View<const Vec3>(rest));
        key.add(settings.young);
        key.add(settings.poisson);
        key.add(settings.density);
        tables.add(key, settings.name, settings.core.has_value(), Extent::Volume, int(rest.size()));
        costs.body_vertices += long(rest.size());
    }
}

std::string per_vertex(const SceneCosts& costs, double bytes)
{
    return short_text(bytes / kKilo / double(std::max(costs.vertex_count(), 1L)));
}

} // namespace

SceneCosts expected_costs(const Scene& scene, const std::vector<SceneCloth>& cloths,
                          const SceneBodies& bodies, bool on_gpu)
{
    SceneCosts costs;
    TableSum tables(scene, on_gpu, costs);
    add_cloths(scene, cloths, tables, costs);
    if (bodies.soft_bodies)
        add_bodies(scene, *bodies.soft_bodies, tables, costs);
    if (on_gpu) {
        const auto cloth = std::size_t(costs.cloth_vertices), body = std::size_t(costs.body_vertices);
        costs.min_bytes = std::size_t(costs.table_bytes) + kCloth.min * cloth + kBody.min * body;
        costs.max_bytes =
            std::size_t(costs.table_bytes) + kCloth.max * cloth + kBody.max * body + kBytesOfScene;
    }
    return costs;
}

SceneCosts expected_costs(const Scene& scene, bool on_gpu)
{
    std::vector<Collider> colliders;
    for (const scene::Avatar& avatar : scene.avatars)
        colliders.emplace_back(avatar, scene.contact.friction);
    const std::vector<SceneCloth> cloths = make_cloths(scene, colliders, {});
    int vertices = 0;
    for (const SceneCloth& cloth : cloths)
        vertices += cloth.vertex_count();
    return expected_costs(scene, cloths, make_bodies(scene, colliders, vertices), on_gpu);
}

std::string table_text(const SceneCosts& costs)
{
    return std::to_string(costs.tables) + " quadrature table" + (costs.tables == 1 ? "" : "s") + " for " +
           std::to_string(costs.parts) +
           (costs.parts == 1 ? " cloth or body of " : " cloths and bodies of ") +
           std::to_string(costs.vertex_count()) + " vertices: about " + short_text(costs.table_seconds) +
           " s to build if none is stored, " + per_vertex(costs, costs.table_bytes) + " kB a vertex";
}

std::string memory_text(const SceneCosts& costs)
{
    return "memory of the GPU: " + in_mebibytes(costs.min_bytes) + " to " + in_mebibytes(costs.max_bytes) +
           " MiB, " + per_vertex(costs, double(costs.min_bytes)) + " to " +
           per_vertex(costs, double(costs.max_bytes)) + " kB a vertex";
}

std::string memory_text(const SceneCosts& costs, const FreeMemory& free)
{
    return memory_text(costs) + "; " + in_mebibytes(free.bytes) + " MiB are free" +
           (costs.max_bytes > free.bytes ? ", which may be too little" : "");
}

std::string why_too_large(const SceneCosts& costs, const FreeMemory& free)
{
    if (costs.max_bytes <= free.bytes)
        return {};
    return free.device + " has " + in_mebibytes(free.bytes) + " MiB left, " +
           std::to_string(costs.vertex_count()) + " vertices may take " + in_mebibytes(costs.max_bytes) +
           " MiB";
}

void require_capacity(const SceneCosts& costs, const FreeMemory& free)
{
    if (costs.min_bytes > free.bytes)
        throw DeviceError(free.device + " is out of memory: " + std::to_string(costs.vertex_count()) +
                          " vertices need " + in_mebibytes(costs.min_bytes) + " to " +
                          in_mebibytes(costs.max_bytes) + " MiB, " + in_mebibytes(free.bytes) +
                          " MiB are free; choose a GPU with more, the backend cpu, or fewer vertices");
}

} // namespace toile::scenes
