#pragma once

#include <string>
#include <vector>

#include "apps/toile/terminal/run_log.h"
#include "core/pd/step/step_report.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// What the frames of a run did not reach: said when it first happens, and summed up at the end.
class Unmet {
public:
    /// @param log  borrowed
    explicit Unmet(const RunLog& log) : log_(log) {}

    void add(int frame, const StepReport& report);

    /// @param counts  [soft bodies] World::inverted_tets()
    void add_inverted(int frame, const std::vector<scene::SoftBody>& bodies, const std::vector<int>& counts);

    /// Prints a line for each kind of shortfall.
    void sum_up(int frames) const;

private:
    struct Kind {
        int frames = 0, first = -1, worst_frame = -1;
        StepReport::Findings worst;
    };
    void add(Kind& kind, int frame, bool is_unmet, const StepReport::Findings& findings,
             const std::string& text);

    const RunLog& log_;
    Kind yielded_, pulled_, displaced_, pinched_, stuck_, unfinished_, inverted_;
};

} // namespace toile::app
