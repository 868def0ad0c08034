#include "research/benchmarks/contact/dressed.h"

#include "scenes/world/world.h"

namespace toile::research::contact_stress {

namespace {

/// One of the two simulations, after settling.
class Half {
public:
    Half(scenes::Scene scene, bool self) : world_(with(std::move(scene), self))
    {
        world_.settle();
        start_ = seconds_by_part(world_.stages());
    }

    bool advance()
    {
        const StepReport report = world_.advance_frame();
        steps_ += report.steps;
        iterations_ += report.iterations;
        contacts_ += report.contacts;
        return report.status != StepReport::Status::NonFinite;
    }

    const scenes::World& world() const { return world_; }
    double iterations() const { return double(iterations_) / steps_; }
    double contacts_at_frames() const { return double(contacts_) / world_.frame(); }

    PartSeconds per_step() const
    {
        PartSeconds parts = difference(seconds_by_part(world_.stages()), start_);
        for (double& seconds : parts)
            seconds /= steps_;
        return parts;
    }

private:
    static scenes::Scene with(scenes::Scene scene, bool self)
    {
        scene.contact.self = self;
        return scene;
    }

    scenes::World world_;
    PartSeconds start_{};
    long steps_ = 0, iterations_ = 0, contacts_ = 0;
};

} // namespace

const std::vector<std::filesystem::path>& dressed_scenes()
{
    static const std::vector<std::filesystem::path> kFiles{
        "scenes/demo/skirt.json", "scenes/data/loose_skirt.json", "scenes/data/layered_dance.json",
        "scenes/data/skirt_walk.json", "scenes/data/skirt_dance.json"};
    return kFiles;
}

DressedResult run(scenes::Scene scene, int threads, const std::function<bool(int)>& after_frame)
{
    scene.solver.method = scene::SolverMethod::Direct;
    scene.solver.threads = threads;
    DressedResult result;
    result.name = scene.source.stem().string();
    Half with(scene, true), without(scene, false);
    for (const scenes::ClothState& cloth : with.world().cloths())
        result.vertices += int(cloth.positions.size());
    while (result.frames + 1 < scene.frames) {
        // The first one finds colder caches: alternate.
        Half& first = result.frames % 2 == 0 ? with : without;
        Half& second = result.frames % 2 == 0 ? without : with;
        const bool is_finite = first.advance() && second.advance();
        ++result.frames;
        if (!after_frame(result.frames) || !is_finite)
            break;
    }
    if (result.frames == 0)
        return result;
    result.contacts = with.contacts_at_frames();
    result.iterations = with.iterations();
    result.iterations_without = without.iterations();
    result.with = with.per_step();
    result.without = without.per_step();
    return result;
}

} // namespace toile::research::contact_stress
