#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "core/pd/step/step_report.h"
#include "scenes/drape/drape.h"
#include "scenes/world/world.h"

namespace toile::scenes {

/// Follows the stages of a drape: tells how far they are, ends them at the time limit, and keeps the last
/// state.
class DrapeWatch {
public:
    /// @param settings, options  outlive the watch
    DrapeWatch(const DrapeSettings& settings, const WorldOptions& options);
    DrapeWatch(const DrapeWatch&) = delete;
    DrapeWatch& operator=(const DrapeWatch&) = delete;

    /// Options of the worlds: those given, with an end of work at the time limit, and every warning once.
    const WorldOptions& options() const { return options_; }

    /// Runs a drape to its end or the time limit. The garments of the result get their last finite state.
    /// @param work  fills the result
    /// @throws Cancelled at the request of the options that were given
    void run(const std::function<void()>& work, DrapeResult& result) const;

    /// @param surfaces  [garments] up to the one that is worked on
    /// @param frame     [s] of motion between samples
    void begin(const std::string& stage, std::vector<GarmentSurface> surfaces, double frame);

    /// Advances by a sample and keeps its state unless it is not finite.
    /// @param duration  of the stage, where it has one [s]; 0: it ends by what happens
    StepReport advance(World& world, double duration = 0.0);

    /// Time steps since the last call.
    int take_steps();

private:
    using Clock = std::chrono::steady_clock;

    bool is_out_of_time() const;
    void end_early(DrapeResult& result) const;

    std::string place() const; ///< stage, and garment where there are several
    void tell(double time, double duration) const;
    double seconds_of_stage() const;

    const DrapeSettings& settings_;
    WorldOptions options_;
    Clock::time_point start_ = Clock::now(), stage_start_ = start_;
    std::string stage_;                 ///< empty: none has begun
    double frame_ = 0.0;                ///< [s]
    int frames_ = 0;                    ///< of the stage
    int stage_steps_ = 0, steps_ = 0;   ///< of the stage; since take_steps()
    std::vector<GarmentSurface> state_; ///< [garments] last finite one; empty before the first stage
};

} // namespace toile::scenes
