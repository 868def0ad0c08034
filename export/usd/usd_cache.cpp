#include "export/usd/usd_cache.h"

#include <sstream>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "export/cache_path.h"
#include "export/usd/usd_frames.h"
#include "export/usd/usd_python.h"

namespace toile::exports {

namespace {

/// Path that means the same in another program.
std::string required(const std::filesystem::path& stage)
{
    std::error_code missing;
    if (!std::filesystem::is_regular_file(stage, missing))
        throw InvalidInput(stage.string() + ": can't be found; check the path");
    return std::filesystem::absolute(stage).string();
}

} // namespace

std::vector<std::string> usd_mesh_paths(const std::filesystem::path& stage)
{
    const ExchangeFolder folder;
    std::istringstream lines(run_usd_command(stage, {"meshes", required(stage)}, folder));
    std::vector<std::string> paths;
    for (std::string path; std::getline(lines, path);)
        paths.push_back(path);
    return paths;
}

std::unique_ptr<const PointCache::Source> open_usd(const std::filesystem::path& file)
{
    const std::filesystem::path stage = archive_of(file);
    const ExchangeFolder folder;
    const std::filesystem::path name = folder.path() / "frames";
    auto frames = std::make_unique<const BinaryFile>(name, BinaryFile::Mode::Create);
    run_usd_command(stage, {"frames", required(stage), mesh_path_of(file), name.string()}, folder);
    return open_usd_frames(std::move(frames), file.string());
}

} // namespace toile::exports
