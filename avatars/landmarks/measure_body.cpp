#include "avatars/landmarks/measure_body.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>

namespace toile::avatars {

namespace {

constexpr double kLevelStep = 0.002; ///< [m] between slices that are compared

/// Level in [low, high] of the largest value.
double highest(double low, double high, const std::function<double(double)>& value)
{
    double best = low, most = -1e300;
    for (double y = low; y <= high; y += kLevelStep)
        if (const double at = value(y); at > most) {
            most = at;
            best = y;
        }
    return best;
}

SectionPlane horizontal(double y)
{
    SectionPlane plane;
    plane.point = Vec3(0.0, y, 0.0);
    return plane;
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

class Tape {
public:
    explicit Tape(const UprightBody& body) : body_(body) { find_levels(); }

    std::vector<Measurement> all()
    {
        lengths();
        girths();
        widths_behind();
        lengths_over_bust();
        shoulders_and_arms();
        return std::move(result_);
    }

    std::vector<Girth> tapes() const
    {
        std::vector<Girth> tapes;
        const auto add = [&](const char* key, const char* side, const SectionPlane& plane, SectionLoop skin,
                             double length) {
            tapes.push_back(in_world({key, side, length, plane, std::move(skin)}));
        };
        for (const auto& [key, y] :
             {std::pair("bust", bust_), {"underbust", underbust_}, {"waist", waist_}, {"hips", hips_}})
            add(key, "", horizontal(y), trunk_slice(body_, y), girth(y));
        const SectionPlane plane = horizontal(thigh_level());
        for (SectionLoop& thigh : thighs())
            add("leg_circ", thigh.center.x() > body_.crotch.x() ? "left" : "right", plane, thigh,
                closed_length(thigh.points));
        for (const Side side : {kLeft, kRight})
            if (const UprightBody::Arm& arm = body_.arm[side]; !arm.wrist_axis.isZero()) {
                const SectionPlane across = SectionPlane::through(arm.wrist, arm.wrist_axis);
                add("wrist", side == kLeft ? "left" : "right", across, around(arm.wrist, across),
                    arm.wrist_tape);
            }
        return tapes;
    }

private:
    /// From the body's own frame.
    Girth in_world(Girth tape) const
    {
        const Mat3& world_from_body = body_.world_from_body;
        for (Vec3* x : {&tape.plane.point, &tape.plane.normal, &tape.plane.u, &tape.plane.v})
            *x = world_from_body * *x;
        for (Vec3& x : tape.skin.points)
            x = world_from_body * x;
        tape.skin = loop_through(std::move(tape.skin.points), tape.plane);
        return tape;
    }

    /// Curve whose middle is nearest to a point of the plane.
    SectionLoop around(const Vec3& point, const SectionPlane& plane) const
    {
        const std::vector<SectionLoop> loops = cut(body_.mesh, plane);
        return *std::min_element(loops.begin(), loops.end(), [&](const SectionLoop& a, const SectionLoop& b) {
            return (a.center - point).squaredNorm() < (b.center - point).squaredNorm();
        });
    }

    double thigh_level() const { return body_.crotch.y() - 0.01; }
    std::vector<SectionLoop> thighs() const
    {
        std::vector<SectionLoop> legs = cut(body_.mesh, horizontal(thigh_level()));
        legs.resize(std::min<size_t>(legs.size(), 2));
        return legs;
    }

    void add(const char* key, double value, const char* meaning)
    {
        result_.push_back({key, value, false, meaning});
    }
    void add_angle(const char* key, double value, const char* meaning)
    {
        result_.push_back({key, value, true, meaning});
    }

    double girth(double y) const
    {
        return closed_length(convex_hull(trunk_slice(body_, y).points, horizontal(y)));
    }
    double front(double y) const { return trunk_slice(body_, y).box.upper.z(); }
    /// Of the trunk at the spine.
    double back(double y) const
    {
        double z = 1e300;
        for (const Vec3& x : trunk_slice(body_, y).points)
            if (std::abs(x.x() - body_.crotch.x()) < 0.01 * body_.height())
                z = std::min(z, x.z());
        return z;
    }

    void find_levels()
    {
        // Largest girths stay near the point that names them: above the bust they grow towards the armpits.
        constexpr double kNear = 0.02, kVeryNear = 0.01; // [m]
        const double H = body_.height(), crotch = body_.crotch.y();
        const double armpit = std::min(body_.arm[kLeft].armpit.y(), body_.arm[kRight].armpit.y());
        const double middle = 0.5 * (crotch + armpit);
        const auto girth_of = [this](double y) { return girth(y); };
        apex_ = find_apex(middle, armpit);
        bust_ = highest(apex_ - kVeryNear, std::min(apex_ + kVeryNear, armpit - kLevelStep), girth_of);
        underbust_ = find_underbust(apex_ - 0.06 * H);
        const double seat = highest(crotch + 0.02 * H, middle,
                                    [this](double y) { return -trunk_slice(body_, y).box.lower.z(); });
        hips_ = highest(seat - kNear, seat + kNear, girth_of);
        find_waist();
        nape_ = Vec3(body_.neck_base.x(), body_.neck_base.y(), back(body_.neck_base.y()));
    }

    /// Level of the foremost points below the armpits and above the belly.
    double find_apex(double low, double armpit) const
    {
        constexpr double kHollow = 0.003; // [m] below the bust, deeper than ripples of a mesh
        double apex = armpit - kLevelStep, foremost = front(apex);
        for (double y = apex; y > low && front(y) > foremost - kHollow; y -= kLevelStep)
            if (front(y) > foremost) {
                foremost = front(y);
                apex = y;
            }
        return apex;
    }

    /// Level at which the girth begins to widen to the bust; of a flat chest, where it is hollowest.
    double find_underbust(double low) const
    {
        constexpr double kWidens = 1.0; // [-] metres of girth in a metre of height
        for (double y = low; y < apex_; y += kLevelStep)
            if (girth(y + 2.0 * kLevelStep) - girth(y) > kWidens * 2.0 * kLevelStep)
                return y;
        return highest(low, apex_, [this](double y) { return -front(y); });
    }

    /// The smallest girth is flat: a tape slides down to where the hips begin.
    void find_waist()
    {
        constexpr double kTightens = 1.005; // [-] girth over the smallest
        double smallest = 1e300;
        for (double y = hips_; y <= underbust_; y += kLevelStep)
            smallest = std::min(smallest, girth(y));
        waist_ = hips_;
        while (waist_ < underbust_ && girth(waist_) > kTightens * smallest)
            waist_ += kLevelStep;
    }

    void lengths()
    {
        add("height", body_.height(), "soles to crown");
        add("head_l", body_.box.upper.y() - nape_.y(), "nape to crown");
        add("waist_line", length_of_back(), "nape to waist, over the back");
        add("vert_bust_line", nape_.y() - bust_, "nape to the level of the bust");
        add("hips_line", waist_ - hips_, "waist to hips");
        add("crotch_hip_diff", hips_ - body_.crotch.y(), "hips to crotch");
    }

    void girths()
    {
        add("bust", girth(bust_), "tape around the trunk at the bust points");
        add("underbust", girth(underbust_), "tape where the trunk begins to widen to the bust");
        add("waist", girth(waist_), "tape at the lowest level within 0.5 % of the smallest girth");
        add("hips", girth(hips_), "tape at the largest girth near the seat");
        double around_thighs = 0.0;
        for (const SectionLoop& thigh : thighs())
            around_thighs += 0.5 * closed_length(thigh.points);
        add("leg_circ", around_thighs, "around a thigh 1 cm below the crotch, mean of both");
        add("wrist", 0.5 * (body_.arm[kLeft].wrist_tape + body_.arm[kRight].wrist_tape),
            "tape at the thinnest slice across the forearm, mean of both");
    }

    /// Points at which the hull of a slice meets the side seam, left first. The seam is plumb from the neck
    /// to the thigh.
    std::array<Vec3, 2> sides(double y) const
    {
        const double z = seam(y);
        std::array<Vec3, 2> side{Vec3(-1e300, y, z), Vec3(1e300, y, z)};
        for_hull_edges(y, [&](const Vec3& a, const Vec3& b) {
            if ((a.z() < z) == (b.z() < z))
                return;
            const double x = a.x() + (z - a.z()) / (b.z() - a.z()) * (b.x() - a.x());
            side[kLeft].x() = std::max(side[kLeft].x(), x);
            side[kRight].x() = std::min(side[kRight].x(), x);
        });
        return side;
    }

    /// Points at which a slice is widest, left first.
    std::array<Vec3, 2> widest(double y) const
    {
        const SectionLoop loop = trunk_slice(body_, y);
        const auto [right, left] =
            std::minmax_element(loop.points.begin(), loop.points.end(),
                                [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
        return {*left, *right};
    }

    double seam(double y) const
    {
        const Vec3 thigh = 0.5 * (body_.leg[kLeft].top + body_.leg[kRight].top);
        const double t = (y - thigh.y()) / (body_.neck_base.y() - thigh.y());
        return thigh.z() + t * (body_.neck_base.z() - thigh.z());
    }

    void for_hull_edges(double y, const std::function<void(const Vec3&, const Vec3&)>& use) const
    {
        const std::vector<Vec3> hull = convex_hull(trunk_slice(body_, y).points, horizontal(y));
        for (size_t i = 0; i < hull.size(); ++i)
            use(hull[i], hull[(i + 1) % hull.size()]);
    }

    /// Tape behind the side seams.
    double behind(double y) const { return behind(y, seam(y)); }
    double behind(double y, double z) const
    {
        double length = 0.0;
        for_hull_edges(y, [&](const Vec3& a, const Vec3& b) {
            const double low = std::min(a.z(), b.z()), high = std::max(a.z(), b.z());
            if (low < z)
                length += (b - a).norm() * (high <= z ? 1.0 : (z - low) / (high - low));
        });
        return length;
    }

    void widths_behind()
    {
        add("back_width", behind(bust_), "part of the bust behind the side seams");
        add("waist_back_width", behind(waist_), "part of the waist behind the side seams");
        add("hip_back_width", behind(hips_), "part of the hips behind the side seams");
        const std::array<Vec3, 2> waist = sides(waist_), hips = sides(hips_);
        const double narrower = 0.5 * ((hips[kLeft] - hips[kRight]).x() - (waist[kLeft] - waist[kRight]).x());
        add_angle("hip_inclination", degrees(std::atan2(narrower, waist_ - hips_)),
                  "side from hips to waist against the vertical");
    }

    /// Points of the bust that face forwards and somewhat outwards, as it does.
    std::array<Vec3, 2> bust_points() const
    {
        const double outwards = std::tan(10.0 * std::numbers::pi / 180.0);
        std::array<Vec3, 2> point;
        const std::vector<Vec3> points = trunk_slice(body_, apex_).points;
        for (const Side side : {kLeft, kRight})
            point[side] = *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
                const double across = side == kLeft ? outwards : -outwards;
                return a.z() + across * a.x() < b.z() + across * b.x();
            });
        return point;
    }

    /// Hull of the profile in the plane of the given x, from the point `a` to the point `b` on the side that
    /// `outside` faces.
    double over(double x, const Vec3& a, const Vec3& b, double outside) const
    {
        SectionPlane plane = SectionPlane::through(Vec3(x, 0.0, 0.0), Vec3::UnitX());
        std::vector<Vec3> points{a, b};
        const Vec3 chord = b - a;
        for (const SectionLoop& loop : cut(body_.mesh, plane))
            for (const Vec3& p : loop.points) {
                const bool between = std::min(a.y(), b.y()) < p.y() && p.y() < std::max(a.y(), b.y());
                if (between && outside * chord.cross(p - a).x() > 0.0)
                    points.push_back(p);
            }
        return closed_length(convex_hull(points, plane)) - chord.norm();
    }

    double length_of_back() const
    {
        const double x = nape_.x();
        return over(x, nape_, Vec3(x, waist_, back(waist_)), 1.0);
    }

    void lengths_over_bust()
    {
        const std::array<Vec3, 2> bust = bust_points();
        add("bust_points", (bust[kLeft] - bust[kRight]).norm(),
            "between the points of the bust that face forwards and 10 degrees outwards");
        double to_bust = 0.0, to_waist = 0.0;
        for (const Side side : {kLeft, kRight}) {
            const Vec3 seam = on_shoulder_seam(side);
            const double x = seam.x();
            to_bust += 0.5 * over(x, seam, Vec3(x, apex_, front_at(x, apex_)), -1.0);
            to_waist += 0.5 * over(x, seam, Vec3(x, waist_, front_at(x, waist_)), -1.0);
        }
        add("bust_line", to_bust, "shoulder seam to the level of the bust, mean of both");
        add("waist_over_bust_line", to_waist, "shoulder seam to waist over the bust, mean of both");
    }

    /// Foremost skin of a level at x.
    double front_at(double x, double y) const
    {
        double z = body_.crotch.z();
        for_crossings(trunk_slice(body_, y), 0, x, [&](const Vec3& p) { z = std::max(z, p.z()); });
        return z;
    }

    /// Points at which a loop crosses a coordinate plane.
    static void for_crossings(const SectionLoop& loop, int axis, double at,
                              const std::function<void(const Vec3&)>& use)
    {
        for (size_t i = 0; i < loop.points.size(); ++i) {
            const Vec3 &a = loop.points[i], &b = loop.points[(i + 1) % loop.points.size()];
            if ((a[axis] < at) != (b[axis] < at))
                use(a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a));
        }
    }

    /// Skin under the line from neck to shoulder tip, a quarter of it from the neck: above the bust.
    Vec3 on_shoulder_seam(Side side) const
    {
        const Vec3 neck = widest(body_.neck_base.y())[side];
        const Vec3 seam = neck + 0.25 * (body_.arm[side].shoulder_tip - neck);
        Vec3 top = seam;
        double highest_skin = -1e300;
        for (const SectionLoop& loop : cut(body_.mesh, SectionPlane::through(seam, Vec3::UnitX())))
            for_crossings(loop, 2, seam.z(), [&](const Vec3& p) {
                if (p.y() > highest_skin && p.y() < seam.y() + 0.03 * body_.height())
                    top.y() = highest_skin = p.y();
            });
        return top;
    }

    void shoulders_and_arms()
    {
        const std::array<UprightBody::Arm, 2>& arm = body_.arm;
        const std::array<Vec3, 2> neck = widest(body_.neck_base.y());
        add("shoulder_w", (arm[kLeft].shoulder_tip - arm[kRight].shoulder_tip).norm(),
            "between the tips of the shoulders, above the armpits");
        add("neck_w", behind(body_.neck_base.y(), 0.5 * (neck[kLeft].z() + neck[kRight].z())),
            "behind the neck at its base, from side to side");
        double armscye = 0.0, length = 0.0, slope = 0.0, angle = 0.0;
        for (const Side side : {kLeft, kRight}) {
            const Vec3& tip = arm[side].shoulder_tip;
            const Vec3 wrist = on_outer_side(arm[side].wrist, arm[side]),
                       elbow = on_outer_side(arm[side].elbow, arm[side]);
            armscye += 0.5 * (tip - arm[side].armpit).norm();
            length += 0.5 * ((elbow - tip).norm() + (wrist - elbow).norm());
            slope += 0.5 * fall(neck[side], tip);
            angle += 0.5 * fall(tip, wrist);
        }
        add("armscye_depth", armscye, "tip of the shoulder to armpit, mean of both");
        add("arm_length", length,
            "tip of the shoulder over the elbow to the outer side of the wrist, mean of both");
        add_angle("shoulder_incl", slope,
                  "side of the neck to the tip of the shoulder against the horizontal");
        add_angle("arm_pose_angle", angle, "tip of the shoulder to wrist against the horizontal");
    }

    /// Skin on the outer side of an arm at a point of its axis: above it in a T-pose.
    Vec3 on_outer_side(const Vec3& center, const UprightBody::Arm& arm) const
    {
        const Vec3 axis = (arm.wrist - arm.shoulder).normalized();
        const Vec3 outer = (Vec3::UnitY() - axis.y() * axis).normalized();
        Vec3 best = center;
        for (const SectionLoop& loop : cut(body_.mesh, SectionPlane::through(center, axis)))
            if ((loop.center - center).norm() < 0.05 * body_.height())
                for (const Vec3& x : loop.points)
                    if (outer.dot(x - best) > 0.0)
                        best = x;
        return best;
    }

    /// Angle below the horizontal from a to b [degrees].
    static double fall(const Vec3& a, const Vec3& b)
    {
        return degrees(std::atan2(a.y() - b.y(), std::abs(a.x() - b.x())));
    }

    const UprightBody& body_;
    std::vector<Measurement> result_;
    double bust_ = 0.0, underbust_ = 0.0, waist_ = 0.0, hips_ = 0.0; ///< levels [m]
    double apex_ = 0.0; ///< level of the foremost points of the bust [m]
    Vec3 nape_ = Vec3::Zero();
};

} // namespace

std::vector<std::string> unmeasured_keys() { return {"bum_points"}; }

std::vector<Measurement> measure_body(const UprightBody& body) { return Tape(body).all(); }

std::vector<Girth> measure_girths(const UprightBody& body) { return Tape(body).tapes(); }

} // namespace toile::avatars
