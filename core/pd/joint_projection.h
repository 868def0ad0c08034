#pragma once

#include <vector>

#include "core/pd/step_projection.h"

namespace toile {

/// Constraints of several cloths in one body, each on its own range of vertices.
class JointProjection : public StepProjection {
public:
    struct Part {
        StepProjection* projection; ///< borrowed
        int first, count;           ///< vertices of the body
    };

    explicit JointProjection(std::vector<Part> parts) : parts_(std::move(parts)) {}

    void observe(View<const Vec3> x) override
    {
        for (const Part& part : parts_)
            part.projection->observe(x.subview(part.first, part.count));
    }

    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override
    {
        for (const Part& part : parts_)
            part.projection->project(x.subview(part.first, part.count),
                                     inverse_masses.subview(part.first, part.count), clear_contacts);
    }

private:
    std::vector<Part> parts_;
};

} // namespace toile
