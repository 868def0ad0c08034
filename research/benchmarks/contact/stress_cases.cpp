#include "research/benchmarks/contact/stress_cases.h"

#include <algorithm>
#include <cmath>

#include "research/benchmarks/contact/sheets.h"

namespace toile::research::contact_stress {

namespace {

/// Minimum number of steps after the throw: long steps would otherwise end before much has happened.
constexpr int kMinSteps = 8;

constexpr double kBallRadius = 0.05; ///< [m]

/// Spacing of sheets at the start, in thicknesses.
constexpr double kSpacing = 2.0;

/// Maximum random shift [m] along x and z each.
constexpr double kShift = 0.02;

std::string number(double value)
{
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.')
        text.pop_back();
    return text;
}

constexpr double kCornerSide = 0.06; ///< [m]

/// Side of the sheets [m]. Sheets of a hundred layers are smaller, or a case would take an hour.
double side_of(int layers) { return layers >= 100 ? 0.04 : layers >= 20 ? 0.08 : 0.14; }

struct Extreme {
    Target target = Target::PinnedSheet;
    int rate = 120;            ///< [1/s]
    double thickness_mm = 1.0; ///< [mm]
    double speed = 2.0;        ///< [m/s]
    int layers = 5;
};

StressCase make_case(const std::string& name, const Extreme& extreme)
{
    StressCase result;
    result.name = "stress " + name;
    result.target = extreme.target;
    result.dt = 1.0 / extreme.rate;
    result.thickness = 1e-3 * extreme.thickness_mm;
    result.speed = extreme.speed;
    result.layers = extreme.layers;
    result.side = side_of(extreme.layers);
    return result;
}

const char* word_of(Target target)
{
    return target == Target::PinnedSheet ? "held sheet" : target == Target::Stack ? "stacks" : "ball";
}

/// Case with all parameters in its name. If cloth is violently deformed, time grows with the square of its
/// vertices: sheets are smaller.
StressCase corner(const Extreme& e)
{
    StressCase result = make_case(std::string(word_of(e.target)) + " dt 1/" + std::to_string(e.rate) +
                                      " thickness " + number(e.thickness_mm) + " mm speed " +
                                      number(e.speed) + " layers " + std::to_string(e.layers),
                                  e);
    result.side = std::min(result.side, kCornerSide);
    return result;
}

/// Builds the scene of a case.
class Thrower {
public:
    Thrower(const StressCase& trial, unsigned seed, int threads)
        : trial_(trial), random_(seed),
          scene_(empty_scene(trial.name, trial.dt, trial.steps(), trial.thickness, threads))
    {
    }

    scenes::Scene make()
    {
        // After their release the sheets fly for a fraction of a step.
        const double travel = trial_.speed * trial_.dt, distance = travel * (1.0 + random_.between(0.2, 0.8));
        const double spacing = kSpacing * trial_.thickness;
        switch (trial_.target) {
        case Target::PinnedSheet:
            attach_corners(add_sheet(scene_, trial_.side, Vec3::Zero(), 0.0));
            throw_stack(trial_.layers - 1, spacing + distance, -travel);
            break;
        case Target::Stack: {
            const int lower = trial_.layers / 2, upper = trial_.layers - lower;
            const double top = -0.5 * (distance + spacing);
            throw_stack(lower, top - (lower - 1) * spacing, 0.5 * travel);
            throw_stack(upper, -top, -0.5 * travel);
            break;
        }
        case Target::Ball:
            add_ball();
            throw_stack(trial_.layers, 2.0 * kBallRadius + 2.0 * scene_.contact.gap + spacing + distance,
                        -travel);
            break;
        }
        return std::move(scene_);
    }

private:
    void attach_corners(const std::string& sheet)
    {
        scene::Attachment attachment;
        attachment.cloth = sheet;
        const double half = 0.5 * trial_.side;
        attachment.select.by = std::vector<Vec3>{Vec3(-half, 0.0, -half), Vec3(half, 0.0, -half),
                                                 Vec3(-half, 0.0, half), Vec3(half, 0.0, half)};
        scene_.attachments.push_back(attachment);
    }

    /// @param lowest  height of the lowest sheet [m]
    /// @param travel  upwards, in the step in which the sheets are attached [m]
    void throw_stack(int count, double lowest, double travel)
    {
        for (int i = 0; i < count; ++i) {
            const double height = lowest + i * kSpacing * trial_.thickness;
            const Vec3 shift(random_.between(-kShift, kShift), height, random_.between(-kShift, kShift));
            scene::Attachment attachment;
            attachment.cloth = add_sheet(scene_, trial_.side, shift, random_.between(0.0, 360.0));
            attachment.select.by =
                scene::SelectBox{Vec3::Constant(-kEverywhere), Vec3::Constant(kEverywhere)};
            attachment.keyframes = {{0.0, Vec3::Zero(), Vec3::Zero()},
                                    {trial_.dt, Vec3(0.0, travel, 0.0), Vec3::Zero()}};
            attachment.release = 1.5 * trial_.dt;
            scene_.attachments.push_back(attachment);
        }
    }

    void add_ball()
    {
        scene::Avatar floor, ball;
        floor.name = "floor";
        floor.shape = scene::Plane{};
        ball.name = "ball";
        ball.shape = scene::Sphere{kBallRadius};
        ball.translate = Vec3(0.0, kBallRadius, 0.0);
        scene_.avatars = {floor, ball};
    }

    static constexpr double kEverywhere = 1e3; ///< [m]

    const StressCase& trial_;
    Random random_;
    scenes::Scene scene_;
};

} // namespace

int StressCase::steps() const { return 1 + std::max(kMinSteps, int(std::lround(duration / dt))); }

int StressCase::vertices() const
{
    const int line = 1 + int(std::lround(side / kEdge));
    return layers * line * line;
}

std::vector<StressCase> stress_cases(Size size)
{
    std::vector<StressCase> cases{make_case("base", {})};
    for (const int rate : {30, 60, 480})
        cases.push_back(make_case("dt 1/" + std::to_string(rate), {.rate = rate}));
    for (const double mm : {0.1, 0.3, 3.0})
        cases.push_back(make_case("thickness " + number(mm) + " mm", {.thickness_mm = mm}));
    for (const double speed : {1.0, 10.0, 50.0, 100.0})
        cases.push_back(make_case("speed " + number(speed) + " m/s", {.speed = speed}));
    for (const int layers : {2, 20, 100})
        cases.push_back(make_case("layers " + std::to_string(layers), {.layers = layers}));
    cases.push_back(make_case("two stacks", {.target = Target::Stack}));
    cases.push_back(make_case("on a ball", {.target = Target::Ball}));

    // Extremes together.
    for (const Target target : {Target::PinnedSheet, Target::Stack, Target::Ball})
        cases.push_back(corner({.target = target, .rate = 30, .thickness_mm = 0.1, .speed = 100.0}));
    cases.push_back(corner({.rate = 480, .thickness_mm = 0.1, .speed = 100.0}));
    cases.push_back(corner({.rate = 30, .thickness_mm = 3.0, .speed = 100.0}));
    cases.push_back(corner({.rate = 30, .thickness_mm = 0.1, .speed = 100.0, .layers = 20}));
    cases.push_back(corner({.rate = 30, .thickness_mm = 0.1, .layers = 100}));

    if (size == Size::Quick)
        for (StressCase& trial : cases) {
            trial.seeds = 1;
            trial.side = trial.layers >= 100 ? 0.02 : trial.layers >= 20 ? 0.03 : 0.5 * trial.side;
            trial.duration = 0.1;
        }
    return cases;
}

scenes::Scene stress_scene(const StressCase& trial, unsigned seed, int threads)
{
    return Thrower(trial, seed, threads).make();
}

} // namespace toile::research::contact_stress
