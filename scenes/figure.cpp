#include "scenes/figure.h"

#include "avatars/load_avatar.h"
#include "core/backend/cuda/array.h"

namespace toile {

namespace {

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

MovingAvatar make_avatar(const scene::Avatar& avatar, const Affine& carried)
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
    return {load_avatar(settings), motion, placement, carried};
}

std::optional<ContactSurface> make_contact_surface(const scene::Avatar& settings, const Avatar& avatar)
{
    if (settings.exclude_bones.empty())
        return std::nullopt;
    const std::string user = "avatar \"" + settings.name + "\": exclude_bones";
    const std::vector<unsigned char> excluded = avatar.faces_on_bones(settings.exclude_bones, user);
    return ContactSurface(avatar.triangles(), excluded, avatar.vertex_count(), user);
}

} // namespace

Figure::Figure(const scene::Avatar& settings, const Affine& carried)
    : avatar_(make_avatar(settings, carried)), contact_(make_contact_surface(settings, avatar_.avatar()))
{
}

bool Figure::advance_to(double t_t1, const Affine& carried)
{
    avatar_.advance_to(t_t1, carried);
    return avatar_.moved();
}

void Figure::pose(View<const Affine> bones, View<Vec3> x) const
{
    TOILE_ASSERT(x.size() == vertex_count());
    const int body = body_vertex_count();
    avatar_.avatar().skin_vertices(bones, x.subview(0, body));
    if (contact_)
        contact_->place_lids(x);
}

Vec3 Figure::vertex_t1(int v) const
{
    const SkinView skin = avatar_.avatar().skin();
    const auto posed = [&](int i) { return skin.posed(i, avatar_.bones_t1()); };
    const int body = body_vertex_count();
    return v < body ? posed(v) : contact_->lids().middle(v - body, posed);
}

/// Bones go to the device, vertices are made there.
class Figure::OnDevice final : public DeviceMeshPoses {
public:
    OnDevice(const CudaSpace& space, const Figure& figure)
        : space_(space), figure_(figure), rest_(space, "figure/rest"), first_(space, "figure/first"),
          influences_(space, "figure/influences"), bones_(space, "figure/bones"),
          first_rim_(space, "figure/first_rim"), rims_(space, "figure/rims")
    {
        const SkinView skin = figure.avatar_.avatar().skin();
        rest_.upload(skin.rest);
        first_.upload(skin.first);
        influences_.upload(skin.influences);
        if (!figure.contact_)
            return;
        first_rim_.upload(figure.contact_->lids().first);
        rims_.upload(figure.contact_->lids().rims);
    }

    void pose_t0(DeviceArray<Vec3>& x) override { pose(figure_.avatar_.bones_t0(), x.view()); }
    void pose_t1(DeviceArray<Vec3>& x) override { pose(figure_.avatar_.bones_t1(), x.view()); }

private:
    void pose(View<const Affine> bones, View<Vec3> x)
    {
        TOILE_ASSERT(x.size() == figure_.vertex_count());
        bones_.upload(bones);
        const int body = rest_.size();
        launch(space_, SkinVertices{{rest_.view(), first_.view(), influences_.view()},
                                    bones_.view(),
                                    x.subview(0, body)});
        if (figure_.contact_)
            launch(space_, PlaceLids{{first_rim_.view(), rims_.view()},
                                     x.subview(0, body),
                                     x.subview(body, x.size() - body)});
    }

    const CudaSpace& space_;
    const Figure& figure_;
    DeviceArray<Vec3> rest_;            ///< see SkinView
    DeviceArray<int> first_;            ///< likewise
    DeviceArray<Influence> influences_; ///< likewise
    DeviceArray<Affine> bones_;         ///< of one end of a step
    DeviceArray<int> first_rim_, rims_; ///< see LidRims
};

std::unique_ptr<DeviceMeshPoses> Figure::on_device(const CudaSpace& space) const
{
    return std::make_unique<OnDevice>(space, *this);
}

} // namespace toile
