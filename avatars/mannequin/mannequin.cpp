#include "avatars/mannequin/mannequin.h"

#include <cmath>

#include "avatars/mannequin/gait.h"
#include "avatars/mannequin/polygonise.h"
#include "avatars/mannequin/rig.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

void require_range(const std::string& setting, double value, double low, double high)
{
    if (!(value >= low && value <= high))
        throw InvalidInput("mannequin: " + setting + " = " + std::to_string(value) + " must lie between " +
                           std::to_string(low) + " and " + std::to_string(high));
}

} // namespace

std::unique_ptr<Avatar> make_mannequin(const MannequinSettings& settings)
{
    require_range("height", settings.height, 1.0, 2.5);
    require_range("edge_length", settings.edge_length, 0.010, 0.020);
    require_range("arm_angle_deg", settings.arm_angle_deg, 25.0, 75.0);
    require_range("walk_period", settings.walk_period, 0.1, 100.0);

    constexpr double kTurnDuration = 2.4; // [s]
    constexpr int kWalkCycles = 6;
    const MannequinShape shape(settings.arm_angle_deg);
    RiggedModel model;
    model.skeleton = make_mannequin_skeleton(shape);
    model.mesh = bind_mannequin(shape, model.skeleton, polygonise(shape, settings.edge_length));
    model.clips = {make_walk(model.skeleton, settings.arm_angle_deg, settings.walk_period, 1, false),
                   make_walk(model.skeleton, settings.arm_angle_deg, settings.walk_period, kWalkCycles, true),
                   make_turn(kTurnDuration)};
    model.metres_from_file = (settings.height / kMannequinHeight) * identity_affine();
    return std::make_unique<SkinnedAvatar>("mannequin", std::move(model));
}

} // namespace toile::avatars
