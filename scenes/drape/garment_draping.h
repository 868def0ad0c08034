#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "garment/pattern/mesh/resampling.h"
#include "scenes/drape/drape.h"
#include "scenes/drape/drape_watch.h"
#include "scenes/drape/dressed_body.h"
#include "scenes/drape/garment.h"
#include "scenes/drape/seam_closing.h"
#include "scenes/drape/stage_scenes.h"

namespace toile::scenes {

/// Drapes one garment over those that are worn: the stages of drape().
class GarmentDraping {
public:
    /// All are kept by reference.
    /// @param worn    gets the garment when it hangs
    /// @param result  gets the garment, and how its drape ended
    GarmentDraping(const DrapeSettings& settings, const Garment& garment, const DressedBody& body,
                   std::vector<WornGarment>& worn, DrapeWatch& watch, DrapeResult& result);

    void run();

private:
    class Clock {
    public:
        double seconds() const
        {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        }

    private:
        std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    };

    void put_on(const GarmentMesh& coarse, GarmentMesh fine);
    bool lies_around_body();
    std::vector<Vec3> placed(const GarmentMesh& mesh);
    bool is_finite(const StepReport& report);
    bool fold(const GarmentMesh& mesh, std::vector<Vec3>& x);
    bool sew(const GarmentMesh& mesh, std::vector<Vec3>& x);
    bool pull(SeamClosing& seams, int& frames);
    bool press(const GarmentMesh& mesh, std::vector<Vec3>& x);
    bool settle(const GarmentMesh& mesh, std::vector<Vec3>& x);
    bool simulate(const Scene& scene, double duration, int& frames, std::vector<Vec3>& x);
    void drape(WornGarment garment);
    bool come_to_rest(const Scene& scene, WornGarment& garment, bool is_held, int& frames);
    void measure_slides(const WornGarment& worn, size_t number);
    void measure_closures();
    void fail(DrapeOutcome outcome, const std::string& text) { fail(outcome, text, number_); }
    void fail(DrapeOutcome outcome, const std::string& text, size_t number);
    void end_stage(const std::string& name, const Clock& clock, int frames, int vertices);
    View<const Vec3> positions(const World& world) const;

    const DrapeSettings& settings_;
    const Garment& garment_;
    const DressedBody& body_;
    std::vector<WornGarment>& worn_;
    DrapeWatch& watch_;
    DrapeResult& result_;
    size_t number_;             ///< of the garment
    double gravity_time_ = 0.0; ///< [s] that gravity has acted on it
    StageScenes stages_;
};

} // namespace toile::scenes
