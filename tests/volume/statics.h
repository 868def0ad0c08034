#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"

namespace toile::test {

/// Linear elasticity: equilibrium of small displacements from rest.
class Statics {
public:
    /// @param rest  [vertices] [m]
    Statics(const std::shared_ptr<Energy>& energy, const std::vector<Vec3>& rest);

    /// Prescribes one component of the displacement of a vertex [m].
    void prescribe(int vertex, int axis, double displacement);
    void add_force(int vertex, const Vec3& force); ///< [N]

    struct Solution {
        std::vector<Vec3> displacements; ///< [vertices] [m]
        std::vector<Vec3> reactions;     ///< [vertices] of what is prescribed [N]
    };
    Solution solve() const;

private:
    Eigen::SparseMatrix<double> stiffness_; ///< [3 vertices x 3 vertices]
    std::vector<char> is_prescribed_;       ///< [3 vertices]
    Eigen::VectorXd displacement_, force_;  ///< [3 vertices]
};

} // namespace toile::test
