#include "research/benchmarks/paper/curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "research/benchmarks/best_time.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::paper {

namespace {

double finite_or_infinite(double value)
{
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

bool is_of_same_method(const Curve& a, const Curve& b)
{
    return a.figure == b.figure && a.problem == b.problem && a.method == b.method;
}

std::string residual_and_error(const Curve::Point& point)
{
    return format("%.2g", point.residual) + " / " + format("%.2g", point.error);
}

/// Least time [ms] of the curves to an error, and its loop.
std::string fastest_to(double error, View<const Curve> curves)
{
    std::string fastest = "-";
    double least = std::numeric_limits<double>::infinity();
    for (const Curve& curve : curves)
        for (const Curve::Point& point : curve.points)
            if (point.error <= error && point.ms < least) {
                least = point.ms;
                fastest = format("%.2f", least) + " " + curve.loop;
            }
    return fastest;
}

} // namespace

void trace(Curve& curve, View<const int> iterations, double seconds, const std::function<int(int)>& solve,
           const std::function<void(Curve::Point&)>& judge)
{
    for (const int count : iterations) {
        Curve::Point& point = curve.points.emplace_back();
        point.ms = best_ms(seconds, [&] { point.iterations = solve(count); });
        judge(point);
        point.residual = finite_or_infinite(point.residual);
        point.error = finite_or_infinite(point.error);
    }
}

std::string csv_of(const std::vector<Curve>& curves)
{
    std::vector<Row> rows;
    for (const Curve& curve : curves)
        for (const Curve::Point& point : curve.points)
            rows.push_back({std::to_string(curve.figure), curve.problem, curve.method, curve.loop,
                            format("%.1f", curve.setup_ms), std::to_string(point.iterations),
                            format("%.3f", point.ms), format("%.3e", point.residual),
                            format("%.3e", point.error)});
    return csv({"figure", "problem", "method", "loop", "setup_ms", "iterations", "ms", "residual", "error"},
               rows);
}

std::string markdown_of(const std::vector<Curve>& curves)
{
    constexpr std::array kLoops{"plain", "line search", "pcg", "l-bfgs"};
    std::vector<Row> rows;
    for (auto first = curves.begin(), end = first; first != curves.end(); first = end) {
        end = std::find_if(first, curves.end(),
                           [&](const Curve& curve) { return !is_of_same_method(curve, *first); });
        const Curve::Point& last = first->points.back();
        Row row{std::to_string(first->figure),
                first->problem,
                first->method,
                format("%.0f", first->setup_ms),
                last.iterations == 0 ? "-" : format("%.3g", last.ms / last.iterations),
                residual_and_error(first->points.front())};
        for (const char* const loop : kLoops) {
            const auto curve = std::find_if(first, end, [&](const Curve& c) { return c.loop == loop; });
            row.push_back(curve == end ? "-" : residual_and_error(curve->points.back()));
        }
        row.push_back(fastest_to(kReached, {&*first, int(end - first)}));
        rows.push_back(std::move(row));
    }
    return markdown({"figure", "problem", "method", "setup ms", "ms an iteration", "after 1", "plain",
                     "line search", "pcg", "l-bfgs", "ms to error 0.01"},
                    rows);
}

} // namespace toile::research::paper
