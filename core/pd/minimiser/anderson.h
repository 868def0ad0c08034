#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Anderson acceleration of the local/global iteration, safeguarded by the value [Peng et al. 2018]. With
/// f = -H^-1 g the plain displacement, the accelerated one is
///
///   d = f - sum_j theta_j (s_j + df_j),    theta = argmin |f - sum_j theta_j df_j|_H
///
/// over the last displacements s_j and the resulting changes df_j of f. If d does not lower the value enough,
/// the plain displacement is taken and the history dropped.
class Anderson : public OuterLoop {
public:
    /// @param window  stored displacements. At least 1.
    explicit Anderson(int window = 5);

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
    void update_history(const Step& step) override;
    bool fall_back() override;
    int max_trials() const override;

private:
    /// Displacement and its effects.
    struct Column {
        std::vector<Vec3> s;  ///< change of x [m]
        std::vector<Vec3> df; ///< change of the plain displacement [m]
        std::vector<Vec3> dg; ///< change of the gradient [N]; H df = -dg gives the H-inner product
    };

    void complete_newest();
    Eigen::VectorXd weights(View<const Vec3> gradient) const;

    int window_;
    std::vector<Column> columns_; ///< oldest first
    std::vector<Column> spare_;   ///< memory of dropped columns, reused
    std::vector<Vec3> plain_;     ///< f at the current point
    std::vector<Vec3> previous_;  ///< f at the previous point
    bool is_current_ = false;     ///< plain_ belongs to the current point
    Eigen::MatrixXd products_;    ///< [columns x columns] <df_i, df_j>_H [J]
};

} // namespace toile
