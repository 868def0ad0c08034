#pragma once

#include <memory>
#include <vector>

#include "garment/seam/sewing.h"

namespace toile::garment {

/// Tacks and buttons: threads that draw two points of cloth together from a time on, and then hold them.
///
/// The free length of a thread that closes shrinks from the distance of its ends,
///
///   l(t) = max(0, l_0 - v (t - t_0)),
///
/// so that its ends approach at v and do not swing past each other.
class Tacks {
public:
    static constexpr double kSpeed = 0.2;        ///< [m/s] v
    static constexpr double kStiffness = 2000.0; ///< [N/m]
    static constexpr double kMaxForce = 50.0;    ///< [N] at which the thread of a button begins to tear

    struct Tack {
        int a = 0, b = 0;      ///< vertices
        double close_at = 0.0; ///< [s] 0: from the first step on
    };

    explicit Tacks(const std::vector<Tack>& tacks);

    const std::shared_ptr<Sewing>& threads() const { return threads_; }

    /// Sets the lengths of the threads for a step from x [m] to the time t_t1 [s].
    void begin_step(double t_t1, View<const Vec3> x);

    /// True if a tack has something to do at time t [s] but hold.
    bool are_closing(double t) const;

private:
    struct Closing {
        double close_at = 0.0; ///< [s]
        double start = 0.0;    ///< [s] t_0
        double gap = 0.0;      ///< [m] l_0

        bool has_begun(double t) const { return close_at <= 0.0 || t >= close_at; }
    };

    std::shared_ptr<Sewing> threads_;
    std::vector<Closing> closings_; ///< [tacks]
};

} // namespace toile::garment
