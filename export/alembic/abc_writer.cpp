#include "export/alembic/abc_writer.h"

#include <set>
#include <string>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/binary_file.h"

namespace toile::exports {

namespace {

/// Names of meshes below one parent, and of those without and of parents.
void require_distinct_names(const std::filesystem::path& file, const CacheLayout& layout)
{
    std::set<std::string> taken, parents;
    const auto take = [&](const std::string& name) {
        if (!taken.insert(name).second)
            throw InvalidInput(file.string() + ": two meshes would be called \"" + name +
                               "\"; give them names that differ in letters, digits or underscores");
    };
    for (const CacheMesh& mesh : layout.meshes) {
        if (!mesh.parent.empty() && parents.insert(mesh.parent).second)
            take(abc_name(mesh.parent));
        take((mesh.parent.empty() ? "" : abc_name(mesh.parent) + "/") + abc_name(mesh.name));
    }
}

} // namespace

AbcWriter::AbcWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial_beside(file_)), order_(file_, layout), layout_(layout)
{
    for (CacheMesh& mesh : layout_.meshes)
        if (mesh.name.empty())
            mesh.name = file_.stem().string();
    require_distinct_names(file_, layout_);
    require_writable(partial_);
    if (layout.resume_at > 0)
        throw InvalidInput(file_.string() + ": an Alembic archive can't be continued; start the run anew, or "
                                            "write a .pc2");
}

void AbcWriter::write(int frame, View<const Vec3> positions)
{
    order_.require_next(frame, positions);
    if (!archive_) {
        archive_.emplace(partial_, layout_, "toile");
        layout_ = {};
    }
    archive_->write(positions);
    order_.advance();
}

std::filesystem::path AbcWriter::complete()
{
    order_.require_complete(partial_);
    archive_->complete();
    return partial_;
}

void AbcWriter::publish() { move_into_place(partial_, file_); }

} // namespace toile::exports
