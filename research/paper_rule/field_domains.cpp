#include "research/paper_rule/field_domains.h"

#include <numeric>

namespace toile::research {

namespace {

/// Box of voxels that grows from the voxel of its vertex.
template <int Dim>
class GrowingBox {
public:
    GrowingBox(const VoxelisedMesh<Dim>& mesh, const Voxel<Dim>& seed, const Eigen::VectorXd& influence,
               bool only_first_side)
        : mesh_(mesh), influence_(influence), only_first_side_(only_first_side), box_{seed, seed},
          held_(influence[mesh.grid().index(seed)])
    {
    }

    const VoxelBox<Dim>& box() const { return box_; }

    /// Grows until the box holds `goal` [m^Dim] or no slice fits any more.
    void grow_until(double goal)
    {
        while (held_ < goal && grow_along_one_axis(goal)) {
        }
    }

private:
    bool grow_along_one_axis(double goal)
    {
        // The cross-section is widest across the shortest axis.
        const auto length = [&](int axis) { return box_.extent(axis) * mesh_.grid().voxel_size[axis]; };
        std::array<int, Dim> axes;
        std::iota(axes.begin(), axes.end(), 0);
        std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return length(a) < length(b); });
        return std::any_of(axes.begin(), axes.end(), [&](int axis) { return grow_along(axis, goal); });
    }

    bool grow_along(int axis, double goal)
    {
        bool is_grown = false;
        for (const int direction : {+1, -1}) {
            if (held_ >= goal || !add_slice(axis, direction))
                continue;
            is_grown = true;
            if (only_first_side_)
                break;
        }
        return is_grown;
    }

    bool add_slice(int axis, int direction)
    {
        VoxelBox<Dim> slice = box_;
        slice.first[axis] = slice.last[axis] = direction > 0 ? box_.last[axis] + 1 : box_.first[axis] - 1;
        if (!mesh_.grid().contains(slice.first))
            return false;

        bool is_covered = true;
        double gained = 0.0;
        slice.for_each([&](const Voxel<Dim>& voxel) {
            const int index = mesh_.grid().index(voxel);
            is_covered &= mesh_.is_covered()[index] != 0;
            gained += influence_[index];
        });
        if (!is_covered)
            return false;
        held_ += gained;
        (direction > 0 ? box_.last : box_.first)[axis] = slice.first[axis];
        return true;
    }

    const VoxelisedMesh<Dim>& mesh_;
    const Eigen::VectorXd& influence_; ///< [voxels] [m^Dim]
    bool only_first_side_;
    VoxelBox<Dim> box_;
    double held_; ///< influence in the box [m^Dim]
};

} // namespace

template <int Dim>
FieldDomains<Dim> field_domains(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                                const DomainSettings& settings)
{
    // Compute the influence of every voxel.
    const Eigen::VectorXd magnitude = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()).cwiseAbs();
    const Eigen::VectorXd influence = mesh.coverage() * magnitude;
    const double total = influence.sum();

    GrowingBox<Dim> box(mesh, mesh.voxel_of(vertex), influence, settings.only_first_side);
    FieldDomains<Dim> domains;
    box.grow_until(settings.near_influence * total);
    domains.near = box.box();
    box.grow_until(settings.middle_influence * total);
    domains.middle = box.box();
    return domains;
}

template FieldDomains<2> field_domains(const VoxelisedMesh<2>&, int, View<const double>,
                                       const DomainSettings&);
template FieldDomains<3> field_domains(const VoxelisedMesh<3>&, int, View<const double>,
                                       const DomainSettings&);

} // namespace toile::research
