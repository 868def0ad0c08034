#include "garment/energy/bending.h"

#include <algorithm>
#include <cmath>

#include "core/backend/error.h"
#include "core/backend/parallel.h"
#include "garment/energy/bending_kernels.h"
#include "garment/energy/device_bending.h"

namespace toile {

namespace {

/// Stiffest bending term of a triangle relative to one of an equilateral triangle of the mean area [-].
/// Slivers would exceed it by the fourth power of their aspect ratio and ruin the conditioning of H.
constexpr double kMaxRelativeStiffness = 1e3;

/// Share of the membrane's diagonal below which bending is left out of H [-]: H then bounds the Hessian to as
/// much, and steps up to twice the bound descend. Cotton on 1 cm cells lies at 5e-4, jersey on 6 mm cells at
/// 2e-2.
constexpr double kNegligible = 0.1;

void require_valid(const Bending::Settings& s, const std::string& source)
{
    const auto check = [&](const char* name, double value) {
        if (!(value >= 0.0) || !std::isfinite(value))
            throw InvalidInput(source + ": bending rigidity " + name + " = " + std::to_string(value) +
                               " N m; it must be 0 or more");
    };
    check("warp", s.warp);
    check("weft", s.weft);
}

/// Adds rows^T stiffness rows.
void add_block(const Bending::Term& term, Triplets& entries)
{
    const CurvatureStencil& stencil = term.stencil;
    const Eigen::MatrixXd block = stencil.weights.transpose() * term.stiffness.asDiagonal() * stencil.weights;
    const int size = int(stencil.vertex.size());
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j)
            entries.emplace_back(stencil.vertex[i], stencil.vertex[j], block(i, j));
}

} // namespace

std::vector<Bending::Term> Bending::terms(const RestShape& rest, const Settings& settings,
                                          const std::string& source)
{
    require_valid(settings, source);
    const Vec3 rigidity(settings.warp, 2.0 * std::sqrt(settings.warp * settings.weft), settings.weft);
    double mean_area = 0.0;
    for (const double area : rest.areas)
        mean_area += area / double(rest.areas.size());
    const double largest = kMaxRelativeStiffness * std::max(settings.warp, settings.weft) / mean_area;

    std::vector<Term> terms;
    std::vector<CurvatureStencil> stencils = curvature_stencils(rest);
    for (size_t t = 0; t < stencils.size(); ++t) {
        if (stencils[t].vertex.empty())
            continue;
        // The largest diagonal entry of the block rows^T stiffness rows is limited.
        Vec3 stiffness = rest.areas[t] * rigidity;
        const double peak = (stiffness.transpose() * stencils[t].weights.cwiseAbs2()).maxCoeff();
        if (peak > largest)
            stiffness *= largest / peak;
        terms.push_back({std::move(stencils[t]), stiffness});
    }
    return terms;
}

Bending::Bending(const std::shared_ptr<const RestShape>& rest, const Settings& settings,
                 const std::string& source)
{
    const int n = rest->vertex_count();
    Triplets entries;
    for (const Term& term : terms(*rest, settings, source))
        add_block(term, entries);
    K_.resize(n, n);
    K_.setFromTriplets(entries.begin(), entries.end());
    vertex_energy_.resize(n);
}

bool Bending::leave_to(View<const double> membrane_diagonal)
{
    in_hessian_ = false;
    for (int v = 0; v < membrane_diagonal.size(); ++v)
        in_hessian_ = in_hessian_ || K_.coeff(v, v) > kNegligible * membrane_diagonal[v];
    return !in_hessian_;
}

void Bending::add_hessian(Triplets& H) const
{
    if (in_hessian_)
        add_constant_curvature(H);
}

void Bending::add_constant_curvature(Triplets& S) const
{
    for (int row = 0; row < K_.outerSize(); ++row)
        for (SparseMatrix::InnerIterator entry(K_, row); entry; ++entry)
            S.emplace_back(int(entry.row()), int(entry.col()), entry.value());
}

double Bending::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const int n = int(K_.rows());
    const BendVertex bend{View<const int>(K_.outerIndexPtr(), n + 1),
                          View<const int>(K_.innerIndexPtr(), int(K_.nonZeros())),
                          View<const double>(K_.valuePtr(), int(K_.nonZeros())), x};
    parallel_for(kCpu, "bending/multiply", n, [&](int i) {
        const Vec3 own = bend.gradient(i);
        gradient[i] += own;
        vertex_energy_[i] = bend.energy(i, own);
    });
    return parallel_sum(kCpu, x.size(), 0.0, [&](int i) { return vertex_energy_[i]; });
}

bool Bending::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceBending>().add(K_, first_vertex);
    return true;
}

} // namespace toile
