#include "research/benchmarks/accuracy/statistics.h"

#include <algorithm>
#include <cmath>

namespace toile::research::accuracy {

double rms(View<const Vec3> a, View<const Vec3> b)
{
    double sum = 0.0;
    for (int i = 0; i < a.size(); ++i)
        sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / a.size());
}

double rms(View<const Vec3> v)
{
    const std::vector<Vec3> zero(v.size(), Vec3::Zero());
    return rms(v, zero);
}

Vec3 mean(View<const Vec3> x)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : x)
        sum += p;
    return sum / x.size();
}

double quantile(std::vector<double> values, double share)
{
    const auto at = values.begin() + long(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace toile::research::accuracy
