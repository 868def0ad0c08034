#include <cstdio>

#include "toile.h"

int main(int, char** argv)
{
    toile::Scene scene = toile::read_scene(argv[1]);
    scene.frames = 5;
    toile::World world(scene);
    const auto layout = toile::cache_layout(world.cloths()[0].rest, world.frame_count());
    const auto cache = toile::make_cache_writer("cloth.pc2", layout);
    cache->write(0, world.cloths()[0].positions);
    while (world.frame() + 1 < world.frame_count()) {
        const toile::StepReport report = world.advance_frame();
        if (report.status == toile::StepReport::Status::NonFinite)
            return 1;
        cache->write(world.frame(), world.cloths()[0].positions);
        std::printf("frame %d: %d iterations, %d contacts\n", world.frame(), report.iterations,
                    report.contacts);
    }
    cache->finish();
}
