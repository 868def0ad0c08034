#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/toile/caches/cache_contents.h"
#include "apps/toile/check/certify.h"
#include "apps/toile/simulate/scene_job.h"
#include "apps/toile/terminal/run_log.h"
#include "core/mesh/obj.h"
#include "export/async_cache_writer.h"
#include "export/folder_lock.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/world/world.h"

namespace toile::app {

/// Caches and start meshes of a run. Until publish() they have partial names, so those of an earlier run
/// stay; other runs are kept out of the folders. Nothing is written before the first frame.
class RunFiles {
public:
    /// Takes the start meshes from the world's current positions.
    /// @param job  outlives this
    /// @throws InvalidInput if a folder is locked or a cache can't be written
    RunFiles(const SceneJob& job, const scenes::World& world, const RunLog& log);

    /// Appends a sample to every cache that has one now. @throws as CacheWriter::write()
    /// @param world  at sample k of with_subframes()
    void write_sample(const scenes::World& world);

    /// Ends a run that stops early: CacheWriter::keep().
    struct Partials {
        int frame_count = 0; ///< that can be read in the longest; a failed GPU does not send all to each
        std::vector<std::filesystem::path> files;
    };
    Partials close();

    /// Completes every cache under its partial name. Those for other programs that can't be made of these
    /// frames do not keep back the rest: undelivered().
    /// @throws as CacheWriter::complete()
    void complete();

    /// Why caches could not be completed, a line each.
    const std::vector<std::string>& undelivered() const { return undelivered_; }

    /// Caches that are complete.
    std::vector<std::filesystem::path> completed() const;

    /// What is to be known of complete caches, a line each.
    std::vector<std::string> notes() const;

    /// Complete caches that can be read with their cloths, one per cloth.
    std::vector<CachedCloth> cloths_to_check(const scenes::World& world) const;

    /// Removes certificates of earlier caches, then moves meshes and caches to their final names. What can't
    /// be moved is kept under its partial name.
    /// @throws DeviceError naming the first file that could not be moved or removed
    void publish();

private:
    struct Cache {
        ExportFile target;
        std::shared_ptr<CacheContents> contents; ///< also of what waits in the writer
        std::unique_ptr<exports::AsyncCacheWriter> writer;
        std::filesystem::path complete; ///< partial name of the complete cache
    };
    /// Outer folders first. Those inside others are released before, so that folders that were made can go.
    struct Locks {
        std::vector<exports::FolderLock> all;
        ~Locks()
        {
            while (!all.empty())
                all.pop_back();
        }
    };
    struct StartMesh {
        std::filesystem::path file;
        ObjMesh mesh; ///< released when it is written
    };

    void write_start_meshes();
    std::vector<std::vector<Vec3>> avatar_positions(int sample);

    const SceneJob& job_;
    int subframes_;
    std::vector<scenes::SceneBody> avatars_; ///< empty: no cache needs them
    Locks locks_;                            ///< before the caches: released after them
    std::vector<Cache> caches_;
    std::vector<StartMesh> meshes_;
    std::vector<std::string> undelivered_;
    bool has_frames_ = false;
};

} // namespace toile::app
