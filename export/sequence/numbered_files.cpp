#include "export/sequence/numbered_files.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "export/cache_format.h"

namespace toile::exports {

bool NumberedFiles::has_digits_placeholder(const std::filesystem::path& pattern)
{
    return pattern.filename().string().find('#') != std::string::npos;
}

NumberedFiles::NumberedFiles(const std::filesystem::path& pattern) : folder_(pattern.parent_path())
{
    if (!has_digits_placeholder(pattern)) {
        prefix_ = pattern.stem().string() + "_";
        suffix_ = pattern.extension().string();
        return;
    }
    const std::string name = pattern.filename().string();
    const size_t begin = name.find('#');
    const size_t end = std::min(name.find_first_not_of('#', begin), name.size());
    prefix_ = name.substr(0, begin);
    suffix_ = name.substr(end);
    digits_ = int(end - begin);
}

std::filesystem::path NumberedFiles::file(int number) const
{
    std::string digits = std::to_string(number);
    if (int(digits.size()) < digits_)
        digits.insert(0, std::string(size_t(digits_) - digits.size(), '0'));
    return folder_ / (prefix_ + digits + suffix_);
}

std::filesystem::path NumberedFiles::pattern() const
{
    return folder_ / (prefix_ + std::string(size_t(digits_), '#') + suffix_);
}

std::string NumberedFiles::stem() const { return prefix_.substr(0, prefix_.find_last_not_of("_.-") + 1); }

std::filesystem::path NumberedFiles::unfinished_folder() const { return folder_ / (stem() + ".partial"); }

NumberedFiles NumberedFiles::unfinished() const
{
    NumberedFiles names = *this;
    names.folder_ = unfinished_folder();
    return names;
}

std::optional<int> NumberedFiles::number_of(const std::string& file_name) const
{
    if (!file_name.starts_with(prefix_) || !file_name.ends_with(suffix_) ||
        file_name.size() < prefix_.size() + suffix_.size() + size_t(digits_))
        return std::nullopt;
    const char* const begin = file_name.data() + prefix_.size();
    const char* const end = file_name.data() + file_name.size() - suffix_.size();
    int number = 0;
    const auto [stopped, error] = std::from_chars(begin, end, number);
    if (error != std::errc{} || stopped != end || file(number).filename() != file_name)
        return std::nullopt;
    return number;
}

std::vector<int> NumberedFiles::existing() const
{
    std::vector<int> numbers;
    std::error_code error;
    const std::filesystem::path folder = folder_.empty() ? "." : folder_;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (const std::optional<int> number = number_of(entry.path().filename().string()))
            numbers.push_back(*number);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

NumberedFiles frames_of_pvd(std::filesystem::path pvd)
{
    return NumberedFiles(pvd.replace_extension(".vtu"));
}

std::optional<NumberedFiles> files_of_frames(const std::filesystem::path& cache, int frame_count)
{
    const CacheFormat format = cache_format(cache);
    if (format == CacheFormat::Vtk)
        return frames_of_pvd(cache);
    if (features_of(format).numbered && (frame_count > 1 || NumberedFiles::has_digits_placeholder(cache)))
        return NumberedFiles(cache);
    return std::nullopt;
}

} // namespace toile::exports
