#include "volume/energy/elastic_solid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/compute/parallel_lanes.h"
#include "volume/energy/cuda/elastic_solid.h"

namespace toile::volume {

Lame ElasticMaterial::lame(const std::string& source) const
{
    if (!(young > 0.0) || !std::isfinite(young))
        throw InvalidInput(source + ": young = " + std::to_string(young) + " Pa; it must be positive");
    if (!(poisson >= 0.0 && poisson <= 0.49))
        throw InvalidInput(source + ": poisson = " + std::to_string(poisson) +
                           "; it must be from 0 to 0.49, for rubber too");
    return {young / (2.0 * (1.0 + poisson)), young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))};
}

ElasticSolid::ElasticSolid(std::shared_ptr<const RestTets> rest, std::vector<Lame> lame)
    : rest_(std::move(rest)), lame_(std::move(lame))
{
    const int tets = rest_->tet_count();
    TOILE_ASSERT(int(lame_.size()) == tets);
    for (int first = 0; first < tets; first += kLanes) {
        Block& block = blocks_.emplace_back();
        for (int k = 0; k < 9; ++k)
            block.rest_inv(k) = gather(first, tets, [&](int t) { return rest_->edges_inv[t](k); });
        block.volume = gather(first, tets, [&](int t) { return rest_->volumes[t]; });
        block.lame.mu = gather(first, tets, [&](int t) { return lame_[t].mu; });
        block.lame.lambda = gather(first, tets, [&](int t) { return lame_[t].lambda; });
    }
    corner_gradient_.resize(tets);
    energy_.resize(tets);
}

void ElasticSolid::add_hessian(Triplets& H) const
{
    for (int t = 0; t < rest_->tet_count(); ++t) {
        const Eigen::Matrix<double, 4, 3> hats = hat_gradients(rest_->edges_inv[t]);
        const Eigen::Matrix4d block =
            rest_->volumes[t] * (2.0 * lame_[t].mu + lame_[t].lambda) * hats * hats.transpose();
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                H.emplace_back(rest_->tets[t][i], rest_->tets[t][j], block(i, j));
    }
}

/// Deformation gradients of eight tetrahedra.
Mat3Of<Lanes> ElasticSolid::deformation_gradients(View<const Vec3> x, int block) const
{
    const int first = block * kLanes, count = rest_->tet_count();
    const std::vector<Tet>& tets = rest_->tets;
    Mat3Of<Lanes> edges;
    for (int i = 0; i < 3; ++i) {
        const Lanes x0 = gather(first, count, [&](int t) { return x[tets[t][0]][i]; });
        for (int k = 0; k < 3; ++k)
            edges(i, k) = gather(first, count, [&](int t) { return x[tets[t][k + 1]][i]; }) - x0;
    }
    return edges.lazyProduct(blocks_[block].rest_inv);
}

double ElasticSolid::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    const int tets = rest_->tet_count();
    parallel_for_lanes(kCpu, "elastic/project", tets, [&](int block) {
        const ElasticResponse<Lanes> response =
            elastic_response<Lanes>(deformation_gradients(x, block), blocks_[block].rest_inv,
                                    blocks_[block].volume, blocks_[block].lame);
        const int first = block * kLanes, lanes = std::min(kLanes, tets - first);
        for (int k = 0; k < lanes; ++k) {
            energy_[first + k] = response.energy[k];
            for (int i = 0; i < 9; ++i)
                corner_gradient_[first + k](i) = response.corner_gradient(i)[k];
        }
    });
    const Incidence& corners = rest_->corners_of_vertex;
    parallel_for(kCpu, "elastic/gather", rest_->vertex_count(), [&](int v) {
        Vec3 sum = Vec3::Zero();
        for (const int item : corners.of(v)) {
            const Mat3& g = corner_gradient_[item / 4];
            if (item % 4 == 0)
                sum -= g.col(0) + g.col(1) + g.col(2);
            else
                sum += g.col(item % 4 - 1);
        }
        gradient[v] += sum;
    });
    return parallel_sum(kCpu, tets, 0.0, [&](int t) { return energy_[t]; });
}

void ElasticSolid::add_couplings(std::vector<std::pair<int, int>>& couplings) const
{
    for (const Tet& tet : rest_->tets)
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                couplings.emplace_back(tet[i], tet[j]);
}

bool ElasticSolid::find_entries(SparseWindow, BlockWindow K)
{
    position_.clear();
    for (const Tet& tet : rest_->tets)
        for (const int row : tet)
            position_.push_back({K.position(row, tet[0]), K.position(row, tet[1]), K.position(row, tet[2]),
                                 K.position(row, tet[3])});
    return false;
}

void ElasticSolid::add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K)
{
    const int tets = rest_->tet_count();
    curvature_.resize(tets);
    parallel_for_lanes(kCpu, "elastic/curvature", tets, [&](int block) {
        const ElasticBlocks<Lanes> of_eight = elastic_blocks<Lanes>(
            elastic_curvature<Lanes>(deformation_gradients(x, block), blocks_[block].lame,
                                     definiteness == Definiteness::Projected),
            blocks_[block].rest_inv, blocks_[block].volume);
        const int first = block * kLanes, lanes = std::min(kLanes, tets - first);
        for (int lane = 0; lane < lanes; ++lane)
            for (int k = 0; k < ElasticBlocks<double>::kCount; ++k)
                for (int i = 0; i < 9; ++i)
                    curvature_[first + lane].of[k](i) = of_eight.of[k](i)[lane];
    });
    const Incidence& corners = rest_->corners_of_vertex;
    parallel_for(kCpu, "elastic/gather_curvature", rest_->vertex_count(), [&](int v) {
        Mat3* const row = K.values(v);
        for (const int item : corners.of(v)) {
            const ElasticBlocks<double>& blocks = curvature_[item / 4];
            const int corner = item % 4;
            for (int k = 0; k < 4; ++k)
                if (k < corner)
                    row[position_[item][k]] +=
                        blocks.of[ElasticBlocks<double>::number(k, corner)].transpose();
                else
                    row[position_[item][k]] += blocks.of[ElasticBlocks<double>::number(corner, k)];
        }
    });
}

bool ElasticSolid::add_to(DeviceEnergies& energies, int first_vertex)
{
    energies.of_kind<DeviceElasticSolid>().add(*rest_, lame_, first_vertex);
    return true;
}

} // namespace toile::volume
