#include "export/usd/usd_file.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/number.h"

namespace toile::exports {

namespace {

/// Text that waits for the disk [bytes].
constexpr size_t kBuffer = size_t{1} << 20;

/// Bytes of the character of UTF-8 that begins the text; 0: none does.
size_t utf8_length(std::string_view text)
{
    const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
    const size_t length = byte(0) < 0x80   ? 1
                          : byte(0) < 0xc2 ? 0
                          : byte(0) < 0xe0 ? 2
                          : byte(0) < 0xf0 ? 3
                          : byte(0) < 0xf5 ? 4
                                           : 0;
    if (length == 0 || length > text.size())
        return 0;
    for (size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xc0) != 0x80)
            return 0;
    // Longer than needed, a half of a pair of UTF-16, or beyond the last character.
    if ((byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
        (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f))
        return 0;
    return length;
}

} // namespace

std::string usd_quoted(const std::string& text)
{
    std::string quoted = "\"";
    for (size_t k = 0; k < text.size();) {
        const auto c = static_cast<unsigned char>(text[k]);
        const size_t length = utf8_length(std::string_view(text).substr(k));
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += text[k];
        } else if (length == 0 || c < 0x20 || c == 0x7f) {
            quoted += '_';
        } else {
            quoted += text.substr(k, length);
        }
        k += std::max<size_t>(length, 1);
    }
    return quoted + '"';
}

UsdFile::UsdFile(std::filesystem::path file)
    : path_(std::move(file)), unfinished_(unique_partial(path_)),
      file_(std::in_place, unfinished_, BinaryFile::Mode::Create)
{
}

UsdFile::~UsdFile()
{
    std::error_code missing;
    if (!unfinished_.empty())
        std::filesystem::remove(unfinished_, missing);
}

UsdFile& UsdFile::operator<<(std::string_view text)
{
    text_ += text;
    flush_beyond(kBuffer);
    return *this;
}

void UsdFile::append(const float* numbers, size_t count, int width)
{
    text_ += '[';
    for (size_t k = 0; k < count; ++k) {
        const bool is_first = k % size_t(width) == 0;
        text_ += k == 0 ? "" : is_first && width > 1 ? "), " : ", ";
        text_ += is_first && width > 1 ? "(" : "";
        text_ += shortest_text(numbers[k]);
        flush_beyond(kBuffer);
    }
    text_ += count > 0 && width > 1 ? ")]" : "]";
}

void UsdFile::append(const std::vector<int>& numbers)
{
    text_ += '[';
    for (size_t k = 0; k < numbers.size(); ++k) {
        text_ += k == 0 ? "" : ", ";
        text_ += std::to_string(numbers[k]);
    }
    *this << "]";
}

void UsdFile::flush_beyond(size_t size)
{
    if (text_.size() <= size)
        return;
    file_->write_at(size_, text_);
    size_ += std::int64_t(text_.size());
    text_.clear();
}

void UsdFile::commit()
{
    flush_beyond(0);
    file_->sync();
    file_->require_in_place();
    file_.reset();
    move_into_place(unfinished_, path_);
    unfinished_.clear();
}

} // namespace toile::exports
