#pragma once

#include "core/base/error.h"
#include "core/pd/step/step_report.h"
#include "export/cache_writer.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/cloth_state.h"
#include "scenes/world/world.h"
#include "scenes/world/world_options.h"

/// The library in one include: scene files, running worlds, point caches.
///
///   toile::World world(toile::read_scene("drape.json"));
///   const auto layout = toile::cache_layout(world.cloths()[0].rest, world.frame_count());
///   const auto cache = toile::make_cache_writer("drape.pc2", layout);
///   cache->write(0, world.cloths()[0].positions);
///   while (world.frame() + 1 < world.frame_count()) {
///       world.advance_frame();
///       cache->write(world.frame(), world.cloths()[0].positions);
///   }
///   cache->finish();
///
/// Names that a short program needs are brought into namespace toile. All others stay in the namespace of
/// their folder, behind that folder's headers.
namespace toile {

using exports::cache_layout;
using exports::CacheLayout;
using exports::CacheWriter;
using exports::make_cache_writer;

using scenes::Backend;
using scenes::ClothState;
using scenes::parse_scene;
using scenes::read_scene;
using scenes::Scene;
using scenes::World;
using scenes::WorldOptions;

} // namespace toile
