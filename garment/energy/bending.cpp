#include "garment/energy/bending.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "garment/energy/bending_kernels.h"
#include "garment/energy/cuda/elasticity.h"

namespace toile::garment {

namespace {

/// Maximum bending stiffness of a triangle relative to an equilateral triangle of the mean area [-].
/// Slivers would exceed it by the fourth power of their aspect ratio and ruin the conditioning of H.
constexpr double kMaxRelativeStiffness = 1e3;

/// Fraction of the membrane's diagonal below which bending is left out of H [-]. H then bounds the Hessian up
/// to that fraction, and steps up to twice the bound descend. Cotton on 1 cm cells lies at 5e-4, jersey on
/// 6 mm cells at 2e-2.
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

/// Terms whose stencil contains a vertex: for v, term[first[v]] to term[first[v + 1]].
struct TermsOfVertices {
    std::vector<int> first, term;
};

TermsOfVertices terms_of_vertices(const std::vector<Bending::Term>& terms, int vertex_count)
{
    TermsOfVertices of;
    of.first.assign(vertex_count + 1, 0);
    for (const Bending::Term& term : terms)
        for (const int v : term.stencil.vertex)
            ++of.first[v + 1];
    std::partial_sum(of.first.begin(), of.first.end(), of.first.begin());
    of.term.resize(of.first.back());
    std::vector<int> next(of.first.begin(), of.first.end() - 1);
    for (int t = 0; t < int(terms.size()); ++t)
        for (const int v : terms[t].stencil.vertex)
            of.term[next[v]++] = t;
    return of;
}

/// Zeros at every pair of vertices that share a term.
SparseMatrix pattern_of(const std::vector<Bending::Term>& terms, int n)
{
    const TermsOfVertices of = terms_of_vertices(terms, n);
    std::vector<std::vector<int>> columns(n);
    parallel_for(kCpu, "bending/columns", n, [&](int v) {
        std::vector<int> all;
        for (int k = of.first[v]; k < of.first[v + 1]; ++k) {
            const std::vector<int>& vertices = terms[of.term[k]].stencil.vertex;
            all.insert(all.end(), vertices.begin(), vertices.end());
        }
        std::sort(all.begin(), all.end());
        columns[v].assign(all.begin(), std::unique(all.begin(), all.end()));
    });
    SparseMatrix K(n, n);
    for (int v = 0; v < n; ++v)
        K.outerIndexPtr()[v + 1] = K.outerIndexPtr()[v] + int(columns[v].size());
    K.resizeNonZeros(K.outerIndexPtr()[n]);
    parallel_for(kCpu, "bending/pattern", n, [&](int v) {
        std::copy(columns[v].begin(), columns[v].end(), K.innerIndexPtr() + K.outerIndexPtr()[v]);
        std::fill_n(K.valuePtr() + K.outerIndexPtr()[v], columns[v].size(), 0.0);
    });
    return K;
}

/// Adds rows^T stiffness rows directly to the matrix. A list of triplets would be four times as long as the
/// matrix.
void add_block(const Bending::Term& term, SparseMatrix& K)
{
    const CurvatureStencil& stencil = term.stencil;
    const Eigen::MatrixXd block = stencil.weights.transpose() * term.stiffness.asDiagonal() * stencil.weights;
    const int size = int(stencil.vertex.size());
    for (int i = 0; i < size; ++i) {
        const int begin = K.outerIndexPtr()[stencil.vertex[i]],
                  end = K.outerIndexPtr()[stencil.vertex[i] + 1];
        for (int j = 0; j < size; ++j) {
            const int* columns = K.innerIndexPtr();
            const int* at = std::lower_bound(columns + begin, columns + end, stencil.vertex[j]);
            K.valuePtr()[at - columns] += block(i, j);
        }
    }
}

} // namespace

std::vector<Bending::Term> Bending::terms(const RestShape& rest, const ByFabric<Settings>& settings,
                                          const std::string& source, const std::vector<int>& hinges)
{
    for (const Settings& fabric : settings.settings)
        require_valid(fabric, source);
    double mean_area = 0.0;
    for (const double area : rest.areas)
        mean_area += area / double(rest.areas.size());

    std::vector<Term> terms;
    std::vector<CurvatureStencil> stencils = curvature_stencils(rest, hinges);
    for (size_t t = 0; t < stencils.size(); ++t) {
        if (stencils[t].vertex.empty())
            continue;
        // Limit the largest diagonal entry of the block rows^T stiffness rows.
        const double warp = settings.stiffness_of(int(t)) * settings.at(int(t)).warp,
                     weft = settings.stiffness_of(int(t)) * settings.at(int(t)).weft;
        Vec3 stiffness = rest.areas[t] * Vec3(warp, 2.0 * std::sqrt(warp * weft), weft);
        const double largest = kMaxRelativeStiffness * std::max(warp, weft) / mean_area;
        const double peak = (stiffness.transpose() * stencils[t].weights.cwiseAbs2()).maxCoeff();
        if (peak > largest)
            stiffness *= largest / peak;
        terms.push_back({std::move(stencils[t]), stiffness});
    }
    return terms;
}

Bending::Bending(const std::shared_ptr<const RestShape>& rest, const ByFabric<Settings>& settings,
                 const std::string& source, const std::vector<int>& hinges)
{
    const int n = rest->vertex_count();
    const std::vector<Term> terms = Bending::terms(*rest, settings, source, hinges);
    K_ = pattern_of(terms, n);
    for (const Term& term : terms)
        add_block(term, K_);
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
        const Vec3 vertex_gradient = bend.gradient(i);
        gradient[i] += vertex_gradient;
        vertex_energy_[i] = bend.energy(i, vertex_gradient);
    });
    return parallel_sum(kCpu, x.size(), 0.0, [&](int i) { return vertex_energy_[i]; });
}

bool Bending::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceElasticity>().add_bending(K_, first_vertex);
    return true;
}

} // namespace toile::garment
