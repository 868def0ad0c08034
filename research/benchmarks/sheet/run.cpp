#include "research/benchmarks/sheet/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/base/process_usage.h"
#include "scenes/world/world.h"

namespace toile::research::sheet {

namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// sqrt(mean |a - b|^2) over vertices [m].
double rms_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / double(a.size()));
}

void set_times(Result& result, const std::vector<double>& step_ms, double user_s)
{
    if (step_ms.size() <= kWarmUp)
        return;
    result.first_ms = step_ms[0];
    const std::vector<double> counted(step_ms.begin() + kWarmUp, step_ms.end());
    result.mean_ms = std::accumulate(counted.begin(), counted.end(), 0.0) / double(counted.size());
    result.median_ms = median(counted);
    result.user_ms = 1e3 * user_s / double(counted.size());
}

} // namespace

Result run(const Sheet& sheet, const Setting& setting, const std::function<bool(int)>& after_step)
{
    Result result;
    result.setting = setting;
    scenes::World world(make_scene(sheet, setting));
    std::vector<double> step_ms;
    long iterations = 0;
    double user_start = 0.0;
    for (int step = 1; step <= sheet.steps; ++step) {
        if (step == kWarmUp + 1)
            user_start = user_seconds();
        const Clock::time_point start = Clock::now();
        const StepReport report = world.advance_frame();
        step_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        iterations += report.iterations;
        result.max_strain = report.max_strain;
        if (std::find(sheet.compared.begin(), sheet.compared.end(), step) != sheet.compared.end())
            result.samples.push_back(world.cloths()[0].positions);
        if (!after_step(step))
            break;
    }
    set_times(result, step_ms, user_seconds() - user_start);
    result.iterations_per_step = double(iterations) / double(step_ms.size());
    return result;
}

Result faster(Result a, Result b) { return b.mean_ms < a.mean_ms ? std::move(b) : std::move(a); }

void compare(const Sheet& sheet, std::vector<Result>& results)
{
    for (Result& result : results) {
        const auto reference = std::find_if(results.begin(), results.end(), [&](const Result& other) {
            return other.setting.is_reference && other.setting.limits_strain == result.setting.limits_strain;
        });
        result.errors.clear();
        if (reference == results.end())
            continue;
        for (size_t k = 0; k < std::min(result.samples.size(), reference->samples.size()); ++k)
            result.errors.push_back(rms_distance(result.samples[k], reference->samples[k]) / sheet.edge());
    }
}

} // namespace toile::research::sheet
