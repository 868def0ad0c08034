#include "avatars/landmarks/body_segments.h"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "avatars/landmarks/skeleton_landmarks.h"
#include "avatars/landmarks/upright_body.h"
#include "core/base/error.h"
#include "core/mesh/topology.h"

namespace toile::avatars {

namespace {

/// Axis with the body's front, rotated by the shortest rotation from upright to the axis.
AxisSegment segment(const Vec3& start, const Vec3& end, const BodyLandmarks& body)
{
    AxisSegment result;
    result.start = start;
    result.end = end;
    const Vec3 front = Eigen::Quaterniond::FromTwoVectors(body.up, result.axis()) * body.front;
    result.front = (front - result.axis().dot(front) * result.axis()).normalized();
    return result;
}

BodySegments segments_of(const BodyLandmarks& body, View<const Vec3> vertices,
                         const std::vector<BodyPart>& part, const std::string& source)
{
    // The axis of the trunk is plumb: its middle bends forwards and backwards.
    const Vec3 bottom = body.crotch + (body.neck_base - body.crotch).dot(body.front) * body.front +
                        (body.neck_base - body.crotch).dot(body.left()) * body.left();
    BodySegments segments{segment(bottom, body.neck_base, body),
                          segment(body.neck_base, body.neck_top, body),
                          segment(body.arm[kLeft].wrist, body.arm[kLeft].shoulder, body),
                          segment(body.arm[kRight].wrist, body.arm[kRight].shoulder, body),
                          segment(body.leg[kLeft].ankle, body.leg[kLeft].top, body),
                          segment(body.leg[kRight].ankle, body.leg[kRight].top, body)};
    static constexpr const char* kNames[] = {"torso",     "neck",     "left arm",
                                             "right arm", "left leg", "right leg"};
    for (size_t s = 0; s < segments.size(); ++s)
        if (!(segments[s].length() > 1e-3))
            throw InvalidInput(source + ": the " + kNames[s] + " has no length; correct its landmarks");
    for (int v = 0; v < vertices.size(); ++v) {
        const BodyPart own = part[size_t(v)];
        segments[size_t(own)].skin.push_back(vertices[v]);
        if (own == BodyPart::LeftLeg || own == BodyPart::RightLeg)
            segments[size_t(BodyPart::Torso)].skin.push_back(vertices[v]);
    }
    return segments;
}

/// Divides the skin of a body without bones: arms are what hangs together with a wrist beyond the shoulder,
/// legs lie below the crotch and the neck above the collarbones.
class SkinParts {
public:
    explicit SkinParts(const UprightBody& body)
        : body_(body), part(body.mesh.positions.size(), BodyPart::Torso)
    {
        for (size_t v = 0; v < part.size(); ++v) {
            const Vec3& x = body.mesh.positions[v];
            if (x.y() < body.crotch.y())
                part[v] = x.x() > body.crotch.x() ? BodyPart::LeftLeg : BodyPart::RightLeg;
            else if (x.y() > body.neck_base.y())
                part[v] = BodyPart::Neck;
        }
        neighbours_ = corners_of_vertices(body.mesh.triangles, body.mesh.vertex_count());
        grow_arm(kLeft, BodyPart::LeftArm);
        grow_arm(kRight, BodyPart::RightArm);
    }

private:
    void grow_arm(Side side, BodyPart arm)
    {
        const auto& x = body_.mesh.positions;
        const Vec3& wrist = body_.arm[side].wrist;
        std::vector<int> queue{int(std::min_element(x.begin(), x.end(),
                                                    [&](const Vec3& a, const Vec3& b) {
                                                        return (a - wrist).squaredNorm() <
                                                               (b - wrist).squaredNorm();
                                                    }) -
                                   x.begin())};
        while (!queue.empty()) {
            const int v = queue.back();
            queue.pop_back();
            if (part[size_t(v)] == arm || !is_beyond_shoulder(side, x[size_t(v)]))
                continue;
            part[size_t(v)] = arm;
            for (const int corner : neighbours_.of(v))
                for (const int other : body_.mesh.triangles[size_t(corner / 3)])
                    queue.push_back(other);
        }
    }

    bool is_beyond_shoulder(Side side, const Vec3& x) const
    {
        const UprightBody::Arm& arm = body_.arm[side];
        const double outwards = side == kLeft ? 1.0 : -1.0;
        return outwards * (x.x() - arm.armpit.x()) > 0.0;
    }

    const UprightBody& body_;
    Incidence neighbours_;

public:
    std::vector<BodyPart> part; ///< [vertices]
};

double distance_to_axis(const AxisSegment& segment, const Vec3& x)
{
    const double t = std::clamp(segment.axis().dot(x - segment.start), 0.0, segment.length());
    return (x - segment.start - t * segment.axis()).norm();
}

/// Divides the skin by the nearest axis.
std::vector<BodyPart> parts_by_axes(const BodyLandmarks& body, View<const Vec3> vertices,
                                    const std::string& source)
{
    const BodySegments axes = segments_of(body, {}, {}, source);
    std::vector<BodyPart> part;
    for (const Vec3& x : vertices) {
        const auto nearest =
            std::min_element(axes.begin(), axes.end(), [&](const AxisSegment& a, const AxisSegment& b) {
                return distance_to_axis(a, x) < distance_to_axis(b, x);
            });
        part.push_back(BodyPart(nearest - axes.begin()));
    }
    return part;
}

BodyArrangement arrange_by_slices(TriangleMesh mesh, const GivenLandmarks& given, const std::string& source)
{
    const std::vector<Vec3> vertices = mesh.positions;
    if (are_complete(given)) {
        BodyArrangement told;
        replace(told.landmarks, given);
        told.segments =
            segments_of(told.landmarks, vertices, parts_by_axes(told.landmarks, vertices, source), source);
        return told;
    }
    const UprightBody body = find_upright_body(std::move(mesh), given, source);
    BodyArrangement result;
    result.landmarks = body.landmarks();
    replace(result.landmarks, given);
    result.segments = segments_of(result.landmarks, vertices, SkinParts(body).part, source);
    return result;
}

} // namespace

BodyArrangement find_segments(Avatar& avatar, const PoseAt& at, const Affine& world_from_avatar,
                              const GivenLandmarks& given)
{
    auto* skinned = dynamic_cast<SkinnedAvatar*>(&avatar);
    if (!skinned)
        return find_segments_by_slices(avatar, at, world_from_avatar, given);
    const PosedSkeleton skeleton = pose_skeleton(*skinned, at, world_from_avatar);
    BodyArrangement result;
    result.landmarks = landmarks_of(skeleton);
    replace(result.landmarks, given);
    result.segments = segments_of(result.landmarks, skeleton.vertices, skeleton.part, avatar.source());
    return result;
}

BodyArrangement find_segments_by_slices(Avatar& avatar, const PoseAt& at, const Affine& world_from_avatar,
                                        const GivenLandmarks& given)
{
    TriangleMesh mesh{std::vector<Vec3>(size_t(avatar.vertex_count())), avatar.triangles()};
    avatar.pose(at, world_from_avatar, mesh.positions);
    return arrange_by_slices(std::move(mesh), given, avatar.source());
}

} // namespace toile::avatars
