#include "export/usd/usd_track.h"

#include <cstring>
#include <utility>

#include "core/base/number.h"

namespace toile::exports {

namespace {

bool same_bits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

} // namespace

UsdTrack::UsdTrack(std::string declaration, int width, std::string metadata)
    : declaration_(std::move(declaration)), metadata_(std::move(metadata)), width_(width)
{
}

void UsdTrack::add(std::vector<float> sample) { samples_.push_back(std::move(sample)); }

void UsdTrack::drop_all_but_last() { samples_.erase(samples_.begin(), samples_.end() - 1); }

void UsdTrack::declare(UsdFile& file, const std::string& indent) const
{
    file << indent << declaration_ << metadata_ << "\n";
}

/// USD holds the first sample before its time and the last after it, so equal ones there are left out. Those
/// between are not: interpolation between equal numbers may round.
void UsdTrack::write(UsdFile& file, const std::string& indent, const std::vector<double>& times) const
{
    size_t first = 0, end = samples_.size();
    while (end > 1 && same_bits(samples_[end - 1], samples_[end - 2]))
        --end;
    while (first + 1 < end && same_bits(samples_[first], samples_[first + 1]))
        ++first;
    if (end - first == 1) {
        file << indent << declaration_ << " = ";
        file.append(samples_[first].data(), samples_[first].size(), width_);
        file << metadata_ << "\n";
        return;
    }
    if (!metadata_.empty())
        declare(file, indent);
    write_samples(file, indent, times, first, end);
}

/// The ends of clips are times to interpolate to, so here nothing is left out.
void UsdTrack::write_all(UsdFile& file, const std::string& indent, const std::vector<double>& times) const
{
    write_samples(file, indent, times, 0, samples_.size());
}

void UsdTrack::write_samples(UsdFile& file, const std::string& indent, const std::vector<double>& times,
                             size_t first, size_t end) const
{
    file << indent << declaration_ << ".timeSamples = {\n";
    for (size_t k = first; k < end; ++k) {
        file << indent << "    " << shortest_text(times[k]) << ": ";
        file.append(samples_[k].data(), samples_[k].size(), width_);
        file << ",\n";
    }
    file << indent << "}\n";
}

} // namespace toile::exports
