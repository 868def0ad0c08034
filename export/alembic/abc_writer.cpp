#include "export/alembic/abc_writer.h"

#include <string>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/archive/names.h"
#include "export/binary_file.h"

namespace toile::exports {

AbcWriter::AbcWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial_beside(file_)), order_(file_, layout),
      layout_(with_names(file_, layout))
{
    require_writable(partial_);
    if (layout.resume_at > 0)
        throw InvalidInput(file_.string() + ": an Alembic archive can't be continued; start the run anew, or "
                                            "write a .pc2");
}

void AbcWriter::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    if (!archive_) {
        archive_.emplace(partial_, layout_, "toile");
        layout_ = {};
    }
    archive_->write(sample);
    order_.advance();
}

std::filesystem::path AbcWriter::complete()
{
    order_.require_complete(partial_);
    archive_->complete();
    return partial_;
}

void AbcWriter::keep()
{
    if (readable_samples() < order_.next())
        archive_->complete();
}

void AbcWriter::publish() { move_into_place(partial_, file_); }

} // namespace toile::exports
