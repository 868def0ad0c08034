#include "export/usd/usd_writer.h"

#include <set>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/archive/names.h"
#include "export/binary_file.h"
#include "export/usd/usd_file.h"

namespace toile::exports {

namespace {

/// Clips are named in the root file.
void require_plain_name(const std::filesystem::path& file)
{
    const std::string name = file.filename().string();
    if (name.find('@') != std::string::npos || usd_quoted(name) != '"' + name + '"')
        throw InvalidInput(
            file.string() +
            ": USD can't name its files; choose a name without @, quotes and control characters");
}

} // namespace

UsdWriter::UsdWriter(std::filesystem::path file, const CacheLayout& layout, const std::string& name)
    : files_(std::move(file)), unfinished_(unfinished_usd(files_.root(), layout.frame_count)),
      order_(files_.root(), layout), name_(name), layout_(with_names(files_.root(), layout)),
      clip_count_(usd_clip_count(layout.frame_count)), moving_(layout.samples_per_second())
{
    require_plain_name(files_.root());
    require_writable(unfinished_.root());
    if (clip_count_ > 0)
        require_writable(files_.clip(0));
    if (layout.resume_at > 0)
        throw InvalidInput(files_.root().string() +
                           ": a USD cache can't be continued; start the run anew, or "
                           "write a .pc2");
}

void UsdWriter::write(int frame, const SampleView& sample)
{
    order_.require_next(frame, sample);
    if (!stage_) {
        remove_partial(); // of an earlier run
        stage_.emplace(name_, layout_);
        layout_ = {};
        if (clip_count_ > 0)
            stage_->write_manifest(unfinished_.manifest());
    }
    if (moving_.advance(sample))
        add_sample();
    order_.advance();
}

/// The first sample of the next clip ends each, so that there is one to interpolate to.
void UsdWriter::add_sample()
{
    stage_->add_sample(moving_.completed());
    if (clip_count_ > 0 && stage_->sample_count() > kUsdSamplesPerFile)
        write_clip();
}

void UsdWriter::write_clip()
{
    const int number = int(clips_.size()), first = number * kUsdSamplesPerFile;
    const std::filesystem::path clip = unfinished_.clip(number);
    stage_->write_clip(clip);
    clips_.push_back({unfinished_.asset(clip), first});
    const int samples = first + stage_->sample_count();
    stage_->write_root(unfinished_.root(), clips_, unfinished_.asset(unfinished_.manifest()), samples);
    readable_ = samples;
    stage_->drop_all_but_last();
}

std::filesystem::path UsdWriter::complete()
{
    order_.require_complete(partial());
    keep();
    return partial();
}

void UsdWriter::keep()
{
    if (moving_.finish())
        add_sample();
    if (readable_ == order_.next())
        return;
    if (clip_count_ > 0) {
        write_clip();
    } else {
        stage_->write_whole(unfinished_.root());
        readable_ = stage_->sample_count();
    }
}

void UsdWriter::publish()
{
    std::set<std::filesystem::path> published;
    const auto move = [&](const std::filesystem::path& complete, const std::filesystem::path& file) {
        create_parent_folder(file);
        move_into_place(complete, file);
        published.insert(file);
    };
    for (int number = 0; number < clip_count_; ++number)
        move(unfinished_.clip(number), files_.clip(number));
    if (clip_count_ > 0)
        move(unfinished_.manifest(), files_.manifest());
    move(unfinished_.root(), files_.root());
    remove_partial();
    for (const std::filesystem::path& old : files_.existing()) {
        std::error_code error;
        if (!published.contains(old) && !std::filesystem::remove(old, error) && error)
            throw DeviceError(old.string() + ": is of an earlier cache and can't be removed (" +
                              error.message() + ")");
    }
    std::error_code missing;
    if (std::filesystem::is_empty(files_.clip_folder(), missing))
        std::filesystem::remove(files_.clip_folder(), missing);
}

void UsdWriter::remove_partial()
{
    std::error_code missing;
    std::filesystem::remove(unfinished_.root(), missing);
    unfinished_.remove_clips();
    if (clip_count_ > 0) // foreign files in the folder prevent its removal
        std::filesystem::remove(unfinished_.root().parent_path(), missing);
}

} // namespace toile::exports
