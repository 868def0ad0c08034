#include "export/usd/usdc_writer.h"

#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "export/archive/names.h"
#include "export/binary_file.h"
#include "export/usd/usd_python.h"

namespace toile::exports {

UsdcWriter::UsdcWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), partial_(partial_beside(file_)),
      frames_(waiting(file_), with_names(file_, layout), file_.stem().string())
{
    require_writable(partial_);
    require_usd_python(file_);
}

std::filesystem::path UsdcWriter::waiting(const std::filesystem::path& file)
{
    return file.string() + ".usda";
}

std::filesystem::path UsdcWriter::complete()
{
    const std::filesystem::path text = frames_.complete();
    std::error_code missing;
    std::filesystem::remove(partial_, missing);
    try {
        run_usd_command(
            file_,
            {"usdc", std::filesystem::absolute(text).string(), std::filesystem::absolute(partial_).string()},
            ExchangeFolder());
        BinaryFile(partial_, BinaryFile::Mode::Continue).sync();
    } catch (...) {
        std::filesystem::remove(partial_, missing);
        throw;
    }
    frames_.remove_partial();
    return partial_;
}

void UsdcWriter::publish() { move_into_place(partial_, file_); }

} // namespace toile::exports
