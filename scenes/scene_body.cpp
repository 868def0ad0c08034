#include "scenes/scene_body.h"

#include "avatars/load_avatar.h"
#include "scenes/shape_mesh.h"

namespace toile {

namespace {

/// The solid of a shape avatar, its lengths scaled; nothing for files and the mannequin.
std::optional<Shape> solid_of(const scene::Avatar& avatar)
{
    if (std::holds_alternative<scene::Plane>(avatar.shape))
        return PlaneShape{};
    if (const auto* sphere = std::get_if<scene::Sphere>(&avatar.shape))
        return SphereShape{sphere->radius * avatar.scale};
    if (const auto* capsule = std::get_if<scene::Capsule>(&avatar.shape))
        return CapsuleShape{0.5 * capsule->length * avatar.scale, capsule->radius * avatar.scale};
    if (const auto* box = std::get_if<scene::Box>(&avatar.shape))
        return BoxShape{0.5 * avatar.scale * box->size};
    return std::nullopt;
}

const char* word_of(scene::LengthUnit unit)
{
    switch (unit) {
    case scene::LengthUnit::Centimetre:
        return "cm";
    case scene::LengthUnit::Millimetre:
        return "mm";
    case scene::LengthUnit::Inch:
        return "in";
    case scene::LengthUnit::Metre:
        break;
    }
    return "m";
}

std::unique_ptr<MovingAvatar> make_figure(const scene::Avatar& avatar)
{
    AvatarSettings settings;
    if (const auto* file = std::get_if<std::filesystem::path>(&avatar.shape))
        settings.file = *file;
    else
        settings.mannequin.height = std::get<scene::Mannequin>(avatar.shape).height;
    if (avatar.unit)
        settings.unit = word_of(*avatar.unit);

    Motion motion;
    motion.clip = avatar.clip;
    motion.loop = avatar.loop;
    motion.speed = avatar.speed;
    motion.start = avatar.start;
    motion.accumulate_root = avatar.accumulate_root;
    motion.pre_roll = {avatar.preroll.hold, avatar.preroll.ease, avatar.preroll.from_bind};
    const Placement placement{avatar.translate, avatar.rotate_deg, avatar.scale};
    return std::make_unique<MovingAvatar>(load_avatar(settings), motion, placement);
}

} // namespace

SceneBody::SceneBody(const scene::Avatar& settings)
    : settings_(settings), shape_(solid_of(settings)), motion_(settings.keyframes, settings.translate)
{
    if (shape_) {
        require_usable(*shape_, settings.name);
        start_pose_.linear() = rotation_of(settings.rotate_deg);
        start_pose_.translation() = settings.translate;
        const auto* plane = std::get_if<scene::Plane>(&settings.shape);
        surface_ = shape_mesh(*shape_, plane != nullptr ? plane->preview_size * settings.scale : 0.0);
        start_surface_ = surface_.positions;
    } else {
        figure_ = make_figure(settings);
        surface_.triangles = figure_->mesh().triangles;
        start_surface_ = figure_->mesh().x_t1;
        exclude_bones();
    }
    place();
}

void SceneBody::exclude_bones()
{
    if (settings_.exclude_bones.empty())
        return;
    const std::string user = "avatar \"" + settings_.name + "\": exclude_bones";
    const std::vector<unsigned char> excluded =
        figure_->avatar().faces_on_bones(settings_.exclude_bones, user);
    contact_.emplace(surface_.triangles, excluded, int(start_surface_.size()), user);
}

bool SceneBody::advance_to(double t)
{
    const bool is_carried = !motion_.is_static() && t != time_;
    time_ = t;
    if (figure_)
        figure_->advance_to(t);
    const bool moved = is_carried || (figure_ && figure_->moved());
    if (moved)
        place();
    return moved;
}

void SceneBody::place()
{
    const Eigen::Isometry3d moved = motion_.at(time_);
    if (shape_)
        pose_ = moved * start_pose_;
    const Eigen::Isometry3d& world_from_start = shape_ ? pose_ : moved;
    const std::vector<Vec3>& start = figure_ ? figure_->mesh().x_t1 : start_surface_;
    surface_.positions.resize(start.size());
    for (size_t i = 0; i < start.size(); ++i)
        surface_.positions[i] = world_from_start * start[i];
    if (contact_)
        contact_->move(surface_.positions);
}

std::vector<SceneBody> make_bodies(const Scene& scene)
{
    std::vector<SceneBody> bodies;
    bodies.reserve(scene.avatars.size());
    for (const scene::Avatar& avatar : scene.avatars)
        bodies.emplace_back(avatar);
    return bodies;
}

} // namespace toile
