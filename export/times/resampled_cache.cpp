#include "export/times/resampled_cache.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/time/sample_times.h"
#include "export/times/frame_times.h"

namespace toile::exports {

namespace {

/// Frames between a sample and the whole frame that it means.
constexpr double kRounding = 1e-4;

/// Most frames: those of ten hours at 100 a second.
constexpr double kMaxFrames = 3.6e6;

class ResampledSource final : public PointCache::Source {
public:
    ResampledSource(PointCache cache, double rate, const std::filesystem::path& file)
        : cache_(std::move(cache)), rate_(rate)
    {
        if (const std::string fault = fault_of_times(cache_.times()); !fault.empty())
            throw InvalidInput(file.string() + ": " + fault + "; export it again");
        first_ = std::floor(cache_.times().front() * rate + kRounding);
        const double last = std::ceil(cache_.times().back() * rate - kRounding);
        if (!(last - first_ < kMaxFrames))
            throw InvalidInput(file.string() + ": lasts " + short_text(last - first_) + " frames at " +
                               short_text(rate) + " a second; " + std::to_string(int(kMaxFrames)) +
                               " are the most");
        vertex_count = cache_.vertex_count();
        frame_count = int(last - first_) + 1;
        fps = rate;
        start_frame = first_;
        axes = cache_.axes();
        if (cache_.mesh() != nullptr)
            mesh = *cache_.mesh();
    }

    std::vector<Vec3> frame(int index) const override
    {
        const SamplePlace place = place_in(cache_.times(), (first_ + index) / rate_);
        std::vector<Vec3> x = cache_.frame(place.sample);
        if (place.part == 0.0)
            return x;
        const std::vector<Vec3> next = cache_.frame(place.sample + 1);
        for (size_t v = 0; v < x.size(); ++v)
            x[v] += place.part * (next[v] - x[v]);
        return x;
    }

private:
    PointCache cache_;
    double rate_, first_ = 0.0;
};

} // namespace

PointCache resampled(const PointCache& cache, double fps, const std::filesystem::path& file)
{
    return PointCache(std::make_unique<ResampledSource>(cache, fps, file));
}

} // namespace toile::exports
