#include "research/paper_rule/field_domains.h"

#include <cmath>

namespace toile::research {

namespace {

/// Box of pixels that grows from the pixel of its vertex.
class GrowingBox {
public:
    GrowingBox(const UvSurface& surface, const Pixel& seed, const Eigen::VectorXd& influence,
               bool only_first_side)
        : surface_(surface), influence_(influence), only_first_side_(only_first_side), box_{seed, seed},
          covered_(influence[surface.grid().index(seed)])
    {
    }

    const PixelBox& box() const { return box_; }

    /// Grows until the box holds `goal` [m^2] or no slice fits any more.
    void grow_until(double goal)
    {
        while (covered_ < goal) {
            const Vec2& pixel = surface_.grid().pixel_size;
            const int axis = box_.extent(1) * pixel.y() >= box_.extent(0) * pixel.x() ? 0 : 1;
            if (!grow_along(axis, goal) && !grow_along(1 - axis, goal))
                return;
        }
    }

private:
    bool grow_along(int axis, double goal)
    {
        bool is_grown = false;
        for (const int direction : {+1, -1}) {
            if (covered_ >= goal || !add_slice(axis, direction))
                continue;
            is_grown = true;
            if (only_first_side_)
                break;
        }
        return is_grown;
    }

    bool add_slice(int axis, int direction)
    {
        const PixelGrid& grid = surface_.grid();
        PixelBox slice = box_;
        slice.first[axis] = slice.last[axis] = direction > 0 ? box_.last[axis] + 1 : box_.first[axis] - 1;
        if (slice.first[axis] < 0 || slice.first[axis] >= grid.size[axis])
            return false;

        double gained = 0.0;
        for (int row = slice.first[1]; row <= slice.last[1]; ++row)
            for (int column = slice.first[0]; column <= slice.last[0]; ++column) {
                const int pixel = grid.index({column, row});
                if (!surface_.is_covered()[pixel])
                    return false;
                gained += influence_[pixel];
            }
        covered_ += gained;
        (direction > 0 ? box_.last : box_.first)[axis] = slice.first[axis];
        return true;
    }

    const UvSurface& surface_;
    const Eigen::VectorXd& influence_; ///< [pixels] [m^2]
    bool only_first_side_;
    PixelBox box_;
    double covered_; ///< influence in the box [m^2]
};

} // namespace

FieldDomains field_domains(const UvSurface& surface, int vertex, View<const double> u,
                           const DomainSettings& settings)
{
    // Compute the influence of every pixel.
    const Eigen::VectorXd magnitude = Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()).cwiseAbs();
    const Eigen::VectorXd influence = surface.coverage() * magnitude;
    const double total = influence.sum();

    GrowingBox box(surface, surface.pixel_of(vertex), influence, settings.only_first_side);
    FieldDomains domains;
    box.grow_until(settings.near_influence * total);
    domains.near = box.box();
    box.grow_until(settings.middle_influence * total);
    domains.middle = box.box();
    return domains;
}

} // namespace toile::research
