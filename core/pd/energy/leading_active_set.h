#pragma once

#include <vector>

#include "core/pd/energy/active_set_energy.h"

namespace toile {

/// Adapter of an energy on the first of a minimiser's unknowns, such as contact of the surface of a solid,
/// whose inner vertices follow.
class LeadingActiveSet : public ActiveSetEnergy {
public:
    /// @param leading  acts on the first `count` of `unknown_count` unknowns; borrowed
    LeadingActiveSet(ActiveSetEnergy& leading, int count, int unknown_count)
        : leading_(leading), count_(count), blocks_(size_t(unknown_count), Mat3::Zero())
    {
    }

    void begin_step(const StepStart& start) override
    {
        leading_.begin_step(
            {first(start.x),
             first(start.prediction),
             first(start.diagonal),
             first(start.fixed),
             first(start.masses),
             start.dt,
             first(start.inertia),
             start.wants_true_hessian,
             {first(start.device.x), first(start.device.prediction), first(start.device.diagonal),
              first(start.device.fixed), first(start.device.masses)}});
    }
    bool may_be_active() const override { return leading_.may_be_active(); }
    bool make_feasible(StepField x) const override { return leading_.make_feasible(first(x)); }
    bool sweep_once(StepField x) const override { return leading_.sweep_once(first(x)); }
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const override
    {
        return leading_.add_gradient(first(x), first(gradient));
    }
    bool activate(View<const Vec3> x) override
    {
        const bool is_active = leading_.activate(first(x));
        const View<const Mat3> blocks = leading_.diagonal_blocks();
        std::copy(blocks.begin(), blocks.end(), blocks_.begin());
        return is_active;
    }
    void add_hessian_product(View<const Vec3> p, View<Vec3> out) const override
    {
        leading_.add_hessian_product(first(p), first(out));
    }
    View<const Mat3> diagonal_blocks() const override { return blocks_; }
    DeviceActiveSet* on_device(const CudaSpace& space) override { return leading_.on_device(space); }
    void append_terms(std::vector<FrozenTerm>& terms) const override { leading_.append_terms(terms); }
    bool has_all_terms() const override { return leading_.has_all_terms(); }
    void mark_touching(StepField x, View<unsigned char> touches) override
    {
        leading_.mark_touching(first(x), first(touches));
    }
    bool revise(StepField x, MinimiserProgress progress) override
    {
        return leading_.revise(first(x), progress);
    }
    void clear(StepField x, StepField v) override { leading_.clear(first(x), first(v)); }
    void resolve(StepField x, StepField v) override { leading_.resolve(first(x), first(v)); }
    bool is_complete() const override { return leading_.is_complete(); }
    bool keep_apart(StepField x, StepField v) override { return leading_.keep_apart(first(x), first(v)); }
    void end_step(StepField x) override { leading_.end_step(first(x)); }
    void abandon_step() override { leading_.abandon_step(); }

private:
    template <typename T>
    View<T> first(View<T> all) const
    {
        return all.empty() ? all : all.subview(0, count_);
    }
    StepField first(StepField all) const { return all.leading(count_); }

    ActiveSetEnergy& leading_;
    int count_;
    std::vector<Mat3> blocks_; ///< [unknowns]
};

} // namespace toile
