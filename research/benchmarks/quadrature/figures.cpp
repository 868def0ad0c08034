/// quadrature_figures FOLDER: writes profile.csv, line.csv, wave.csv, square.csv, sheet.csv and solver.csv.
/// The first five are the paper's figures 3, 5, 6 and their equivalent on cloth: relative integration errors.
/// The last is the rule as a global step. plot.py draws them.

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <numbers>
#include <string>

#include "core/base/atomic_file.h"
#include "core/linear/cholesky.h"
#include "research/benchmarks/quadrature/integrals.h"
#include "research/paper_rule/paper_rule.h"

namespace toile::research {

namespace {

constexpr double kEpsilon = 0.05;
const char* const kErrorNames = "gauss_legendre_3,gauss_legendre_4,gaussian_alone,stacked_no_penalty,stacked";

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string row(const IntegrationErrors& e)
{
    return number(e.gauss_legendre_3) + "," + number(e.gauss_legendre_4) + "," + number(e.gaussian_alone) +
           "," + number(e.stacked_no_penalty) + "," + number(e.stacked) + "\n";
}

/// Figure 3: a centred peak and its two Gaussians (zero outside of the near box) at every hundredth.
std::string profile()
{
    std::string csv = "near_share,x,target,gaussian_no_penalty,gaussian\n";
    for (const double fraction : {0.7, 0.9}) {
        const YukawaLine target(0.0, 0.2, kEpsilon);
        const GaussianFits<1> fits = fits_on_line(target, fraction);
        for (int step = -100; step <= 100; ++step) {
            const Point<1> x(0.01 * step);
            const bool is_near = fits.near.contains(x);
            csv += number(fraction) + "," + number(x[0]) + "," + number(target(x[0])) + "," +
                   number(is_near ? fits.no_penalty.value(x) : 0.0) + "," +
                   number(is_near ? fits.penalty.value(x) : 0.0) + "\n";
        }
    }
    return csv;
}

/// Figures 5 and 6: peaks along the line, or their products with themselves.
std::string lines(bool is_square)
{
    std::string csv = std::string("near_share,lambda,peak,") + kErrorNames + "\n";
    for (const double fraction : {0.7, 0.8, 0.9})
        for (const double lambda : {0.1, 0.2, 0.3})
            for (int step = -10; step <= 10; ++step) {
                const YukawaLine target(0.05 * step, lambda, kEpsilon);
                csv += number(fraction) + "," + number(lambda) + "," + number(target.peak()) + "," +
                       row(is_square ? errors_on_square(target, target, fraction)
                                     : errors_on_line(target, fraction));
            }
    return csv;
}

/// Figure 5: the same peaks times a wave of half a period, one and two in [-1, 1].
std::string waves()
{
    std::string csv = std::string("near_share,omega,peak,") + kErrorNames + "\n";
    for (const double fraction : {0.7, 0.9})
        for (const double omega : {0.5 * std::numbers::pi, std::numbers::pi, 2.0 * std::numbers::pi})
            for (int step = -10; step <= 10; ++step) {
                const YukawaLine target(0.05 * step, 0.2, kEpsilon);
                csv += number(fraction) + "," + number(omega) + "," + number(target.peak()) + "," +
                       row(errors_on_wave(target, omega, fraction));
            }
    return csv;
}

/// Errors at every fourth vertex of a sheet of 31 x 31 under the load of inertia.
std::string sheets()
{
    constexpr int kSide = 31;
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const VoxelisedMesh<2> mesh(sheet.uv, sheet.triangles, 64);
    std::vector<double> b;
    for (const Vec3& force : smooth_load(sheet))
        b.push_back(force.x());
    std::string csv = std::string("stiffness,x,y,") + kErrorNames + "\n";
    for (const double k : {10.0, 100.0, 1e3, 1e4}) {
        const SparseMatrix H = sheet_matrix(sheet, k);
        for (int i = 2; i < kSide; i += 4)
            for (int j = 2; j < kSide; j += 4) {
                const int vertex = i * kSide + j;
                csv += number(k) + "," + number(sheet.uv[vertex].x()) + "," + number(sheet.uv[vertex].y()) +
                       "," + row(errors_on_sheet(mesh, vertex, kernel_row(H, vertex), b, {}));
            }
    }
    return csv;
}

/// |x - exact| / |exact| of one application, and the growth of x -= solve(H x) after 60 iterations.
std::string solver_row(const Sheet& sheet, double k, Denominator denominator, int order, double penalty)
{
    const SparseMatrix H = sheet_matrix(sheet, k);
    PaperRule::Settings settings;
    settings.denominator = denominator;
    settings.rule.order = order;
    settings.rule.penalty = penalty;
    PaperRule rule(sheet.uv, sheet.triangles, settings);
    rule.update(H, std::vector<unsigned char>(sheet.vertex_count(), 0));

    const int n = sheet.vertex_count();
    const std::vector<Vec3> b = smooth_load(sheet);
    std::vector<Vec3> x(n), exact(n), z(n);
    rule.solve(b, x);
    Cholesky(H).solve(b, exact);
    double squared = 0.0, of_exact = 0.0;
    for (int i = 0; i < n; ++i) {
        squared += (x[i] - exact[i]).squaredNorm();
        of_exact += exact[i].squaredNorm();
    }

    constexpr int kIterations = 60, kMeasured = 20;
    double log_growth = 0.0;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        double norm = 0.0;
        for (const Vec3& value : x)
            norm += value.squaredNorm();
        if (iteration > kIterations - kMeasured)
            log_growth += 0.5 * std::log(norm) / (kMeasured - 1);
        for (Vec3& value : x)
            value /= std::sqrt(norm);
        for (int i = 0; i < n; ++i)
            z[i] = row_times(H, i, x);
        rule.solve(z, z);
        for (int i = 0; i < n; ++i)
            x[i] -= z[i];
    }
    return number(k) + "," + (denominator == Denominator::Exact ? "exact," : "same_rule,") + number(order) +
           "," + number(penalty) + "," + number(std::sqrt(squared / of_exact)) + "," +
           number(std::exp(log_growth)) + "\n";
}

std::string solvers()
{
    const Sheet sheet = unit_sheet(31, 0.2);
    std::string csv = "stiffness,denominator,order,penalty,relative_error,spectral_radius\n";
    for (const double k : {10.0, 100.0, 1e3, 1e4})
        for (const Denominator denominator : {Denominator::SameRule, Denominator::Exact})
            for (const int order : {3, 4})
                for (const double penalty : {0.0, 100.0})
                    csv += solver_row(sheet, k, denominator, order, penalty);
    return csv;
}

} // namespace

} // namespace toile::research

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: quadrature_figures FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder(argv[1]);
        toile::write_atomically(folder / "profile.csv", toile::research::profile());
        toile::write_atomically(folder / "line.csv", toile::research::lines(false));
        toile::write_atomically(folder / "wave.csv", toile::research::waves());
        toile::write_atomically(folder / "square.csv", toile::research::lines(true));
        toile::write_atomically(folder / "sheet.csv", toile::research::sheets());
        toile::write_atomically(folder / "solver.csv", toile::research::solvers());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "quadrature_figures: %s\n", error.what());
        return 1;
    }
    return 0;
}
