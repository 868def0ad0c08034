#include "scenes/colliders/skinned_collider.h"

#include "avatars/model/cached_avatar.h"
#include "avatars/retarget/add_motion.h"
#include "core/base/error.h"
#include "core/compute/cuda/array.h"
#include "scenes/colliders/load_body.h"

namespace toile::scenes {

namespace {

/// @throws InvalidInput for a cache of one pose that is to be played
void require_motion_for(const scene::Avatar& avatar, const avatars::Avatar& body)
{
    const bool has_pace = avatar.speed != 1.0 && avatar.speed != 0.0;
    if (body.is_static() && (avatar.loop || avatar.start != 0.0 || has_pace))
        throw InvalidInput(body.source() + ": has one sample, so loop, start and speed have no effect; " +
                           "remove them or export more");
}

avatars::MovingAvatar make_avatar(const scene::Avatar& avatar, const avatars::Affine& root_transform)
{
    std::unique_ptr<avatars::Avatar> body = load_body(avatar);
    avatars::Motion motion;
    motion.clip = avatar.clip;
    if (const auto* cached = dynamic_cast<const avatars::CachedAvatar*>(body.get())) {
        require_motion_for(avatar, *cached);
        if (motion.clip.empty() && !cached->is_static())
            motion.clip = avatars::CachedAvatar::kClip;
    }
    if (avatar.motion)
        motion.clip = add_motion(*body, {avatar.motion->file, avatar.motion->clip, avatar.motion->map});
    motion.loop = avatar.loop;
    motion.speed = avatar.speed;
    motion.start = avatar.start;
    motion.accumulate_root = avatar.accumulate_root;
    motion.pre_roll = {avatar.preroll.hold, avatar.preroll.ease, avatar.preroll.from_bind};
    const avatars::Placement placement{avatar.translate, avatar.rotate_deg, avatar.scale};
    return {std::move(body), motion, placement, root_transform};
}

std::optional<avatars::ContactSurface> make_contact_surface(const scene::Avatar& settings,
                                                            const avatars::Avatar& avatar)
{
    if (settings.exclude_bones.empty())
        return std::nullopt;
    const std::string user = "avatar \"" + settings.name + "\": exclude_bones";
    const std::vector<unsigned char> excluded = avatar.faces_on_bones(settings.exclude_bones, user);
    return avatars::ContactSurface(avatar.triangles(), excluded, avatar.vertex_count(), user);
}

} // namespace

SkinnedCollider::SkinnedCollider(const scene::Avatar& settings, const avatars::Affine& root_transform)
    : avatar_(make_avatar(settings, root_transform)),
      contact_(make_contact_surface(settings, avatar_.avatar()))
{
    if (settings.self_contact == scene::SelfContact::Keep || avatar_.is_static())
        return;
    insets_.emplace(avatar_, faces_for_contact());
    insets_t1_ = insets_->at(avatar_, 0.0);
    insets_t0_ = insets_t1_;
}

/// Faces of the body that cloth collides with.
std::vector<Triangle> SkinnedCollider::faces_for_contact() const
{
    std::vector<Triangle> faces;
    for (int t = 0; t < int(contact_triangles().size()); ++t)
        if (face_of(t) >= 0)
            faces.push_back(contact_triangles()[size_t(t)]);
    return faces;
}

bool SkinnedCollider::advance_to(double t_t1, const avatars::Affine& root_transform)
{
    avatar_.advance_to(t_t1, root_transform);
    if (!insets_)
        return avatar_.moved();
    insets_t0_ = std::move(insets_t1_);
    insets_t1_ = insets_->at(avatar_, t_t1);
    return avatar_.moved() || insets_t0_ != insets_t1_;
}

double SkinnedCollider::max_motion_to(double t, const avatars::Affine& root_transform)
{
    double largest = avatar_.max_motion_to(t, root_transform);
    if (!insets_)
        return largest;
    const std::vector<double> insets = insets_->at(avatar_, t);
    double change = 0.0;
    for (size_t v = 0; v < insets.size(); ++v)
        change = std::max(change, std::abs(insets[v] - insets_t1_[v]));
    return largest + change;
}

avatars::SkinView SkinnedCollider::skin(View<const double> insets) const
{
    avatars::SkinView skin = avatar_.avatar().skin();
    if (insets_) {
        skin.inward = insets_->inward();
        skin.insets = insets;
    }
    return skin;
}

void SkinnedCollider::pose(View<const avatars::Affine> bones, View<const double> insets, View<Vec3> x) const
{
    TOILE_ASSERT(x.size() == vertex_count());
    const int body = body_vertex_count();
    avatars::Avatar::skin_vertices(skin(insets), bones, x.subview(0, body));
    if (contact_)
        contact_->place_lids(x);
}

int SkinnedCollider::nearest_vertex(const Vec3& x, double max_distance) const
{
    const avatars::SkinView skin = this->skin(insets_t1_);
    int nearest = -1;
    double min_square = max_distance * max_distance;
    for (int v = 0; v < body_vertex_count(); ++v) {
        const double square = (skin.posed(v, avatar_.bones_t1()) - x).squaredNorm();
        if (square < min_square) {
            min_square = square;
            nearest = v;
        }
    }
    return nearest;
}

Vec3 SkinnedCollider::vertex_t1(int v) const
{
    const avatars::SkinView skin = this->skin(insets_t1_);
    const auto posed = [&](int i) { return skin.posed(i, avatar_.bones_t1()); };
    const int body = body_vertex_count();
    return v < body ? posed(v) : contact_->lids().middle(v - body, posed);
}

/// Poses on a GPU: bones are uploaded, vertices are computed on the device.
class SkinnedCollider::OnDevice final : public collision::DeviceMeshPoses {
public:
    OnDevice(const CudaSpace& space, const SkinnedCollider& skinned)
        : space_(space), skinned_(skinned), rest_(space, "skinned/rest"), first_(space, "skinned/first"),
          influences_(space, "skinned/influences"), first_offset_(space, "skinned/first_offset"),
          offsets_(space, "skinned/offsets"), inward_(space, "skinned/inward"),
          insets_(space, "skinned/insets"), bones_(space, "skinned/bones"),
          first_rim_(space, "skinned/first_rim"), rims_(space, "skinned/rims")
    {
        const avatars::SkinView skin = skinned.avatar_.avatar().skin();
        rest_.upload(skin.rest);
        first_.upload(skin.first);
        influences_.upload(skin.influences);
        first_offset_.upload(skin.first_offset);
        offsets_.upload(skin.offsets);
        first_shape_ = skin.first_shape;
        if (skinned.insets_)
            inward_.upload(skinned.insets_->inward());
        if (!skinned.contact_)
            return;
        first_rim_.upload(skinned.contact_->lids().first);
        rims_.upload(skinned.contact_->lids().rims);
    }

    void pose_t0(DeviceArray<Vec3>& x) override
    {
        pose(skinned_.avatar_.bones_t0(), skinned_.insets_t0_, x.view());
    }
    void pose_t1(DeviceArray<Vec3>& x) override
    {
        pose(skinned_.avatar_.bones_t1(), skinned_.insets_t1_, x.view());
    }

private:
    void pose(View<const avatars::Affine> bones, View<const double> insets, View<Vec3> x)
    {
        TOILE_ASSERT(x.size() == skinned_.vertex_count());
        bones_.upload(bones);
        insets_.upload(insets);
        const int body = rest_.size();
        launch(space_,
               avatars::SkinVertices{{rest_.view(), first_.view(), influences_.view(), first_offset_.view(),
                                      offsets_.view(), first_shape_, inward_.view(), insets_.view()},
                                     bones_.view(),
                                     x.subview(0, body)});
        if (skinned_.contact_)
            launch(space_, avatars::PlaceLids{{first_rim_.view(), rims_.view()},
                                              x.subview(0, body),
                                              x.subview(body, x.size() - body)});
    }

    const CudaSpace& space_;
    const SkinnedCollider& skinned_;
    DeviceArray<Vec3> rest_;                     ///< see SkinView
    DeviceArray<int> first_;                     ///< likewise
    DeviceArray<avatars::Influence> influences_; ///< likewise
    DeviceArray<int> first_offset_;              ///< likewise
    DeviceArray<avatars::ShapeOffset> offsets_;  ///< likewise
    int first_shape_ = 0;                        ///< likewise
    DeviceArray<Vec3> inward_;                   ///< likewise
    DeviceArray<double> insets_;                 ///< of one end of a step
    DeviceArray<avatars::Affine> bones_;         ///< of one end of a step
    DeviceArray<int> first_rim_, rims_;          ///< see LidRims
};

std::unique_ptr<collision::DeviceMeshPoses> SkinnedCollider::on_device(const CudaSpace& space) const
{
    return std::make_unique<OnDevice>(space, *this);
}

} // namespace toile::scenes
