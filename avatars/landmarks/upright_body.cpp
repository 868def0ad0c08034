#include "avatars/landmarks/upright_body.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/base/number.h"

namespace toile::avatars {

namespace {

/// Slices above and below a level are this far apart, over the body's height [-].
constexpr double kStep = 0.005;
/// A smaller part of a slice is a finger or a cavity, over the square of the body's height [-].
constexpr double kMinArea = 4e-4;

/// Level between `low` and `high` at which a property of slices changes, to a tenth of a millimetre.
double bisect(double low, double high, const std::function<bool(double)>& is_below)
{
    while (high - low > 1e-4) {
        const double middle = 0.5 * (low + high);
        (is_below(middle) ? low : high) = middle;
    }
    return low;
}

double tape(const SectionLoop& loop, const SectionPlane& plane)
{
    return closed_length(convex_hull(loop.points, plane));
}

SectionPlane level(double y)
{
    SectionPlane plane;
    plane.point = Vec3(0.0, y, 0.0);
    return plane;
}

class Finder {
public:
    Finder(TriangleMesh mesh, const GivenLandmarks& given, const std::string& source) : given_(given)
    {
        body_.source = source;
        body_.mesh = std::move(mesh);
        measure_box();
    }

    UprightBody find()
    {
        find_legs();
        require_metres();
        turn_to_front();
        find_crotch();
        for (const Side side : {kLeft, kRight})
            find_leg(side);
        for (const Side side : {kLeft, kRight})
            find_arm(side);
        find_neck();
        return std::move(body_);
    }

private:
    [[noreturn]] void fail(const std::string& part, const std::string& why) const
    {
        throw InvalidInput(
            body_.source + ": " + part + " can't be found: " + why +
            "; use a body that stands upright on two legs, arms away from it, or give its landmarks");
    }

    bool is_given(const std::string& name) const { return given_.contains(name); }
    Vec3 given(const std::string& name) const { return body_.world_from_body.transpose() * given_.at(name); }

    void measure_box()
    {
        body_.box = bounds(body_.mesh.positions);
        if (!(body_.height() > 0.0))
            fail("a body", "it has no height");
    }
    double at_height(double fraction) const { return body_.box.lower.y() + fraction * body_.height(); }
    double step() const { return kStep * body_.height(); }

    std::vector<SectionLoop> parts(double y) const
    {
        std::vector<SectionLoop> loops = cut(body_.mesh, level(y));
        const double smallest = kMinArea * body_.height() * body_.height();
        std::erase_if(loops, [&](const SectionLoop& loop) { return loop.area < smallest; });
        return loops;
    }

    /// Both legs are what slices at shins and knees show.
    void find_legs()
    {
        for (const double fraction : {0.10, 0.15, 0.20, 0.25}) {
            const std::vector<SectionLoop> legs = parts(at_height(fraction));
            if (legs.size() != 2 || legs[1].area < 0.5 * legs[0].area)
                fail("two legs", "a slice at " + short_text(100.0 * fraction) + " % of the height has " +
                                     std::to_string(legs.size()) +
                                     (legs.size() == 1   ? " part"
                                      : legs.size() == 2 ? " parts of different sizes"
                                                         : " parts"));
        }
    }

    void require_metres() const
    {
        constexpr double kMin = 0.3, kMax = 3.0; // [m]
        if (body_.height() < kMin || body_.height() > kMax)
            throw InvalidInput(body_.source + ": stands " + short_text(body_.height()) +
                               " m tall; give the unit of its file, m, cm, mm or in");
    }

    /// Rotates the mesh about the vertical until it faces +Z.
    void turn_to_front()
    {
        const auto level_out = [](const Vec3& x) { return Vec3(x.x(), 0.0, x.z()).normalized(); };
        const Vec3 front =
            is_given("front") ? level_out(given_.at("front")) : snapped(level_out(direction_of_toes()));
        body_.world_from_body.col(0) = Vec3::UnitY().cross(front);
        body_.world_from_body.col(1) = Vec3::UnitY();
        body_.world_from_body.col(2) = front;
        for (Vec3& x : body_.mesh.positions)
            x = body_.world_from_body.transpose() * x;
        measure_box();
    }

    /// Bodies face an axis; their legs are symmetrical to some degrees only.
    static Vec3 snapped(const Vec3& front)
    {
        constexpr double kCosine = 0.985; // [-] of 10 degrees
        for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitX())})
            if (std::abs(axis.dot(front)) > kCosine)
                return axis.dot(front) > 0.0 ? axis : Vec3(-axis);
        return front;
    }

    Vec3 direction_of_toes() const
    {
        const std::vector<SectionLoop> shins = parts(at_height(0.10)), feet = parts(at_height(0.02));
        const Vec3 across = (shins[0].center - shins[1].center).normalized();
        Vec3 along = Vec3::Zero();
        for (const SectionLoop& foot : feet) {
            const bool second =
                (foot.center - shins[1].center).norm() < (foot.center - shins[0].center).norm();
            along += foot.center - shins[second ? 1 : 0].center;
        }
        along.y() = 0.0;
        along -= across.dot(along) * across;
        if (feet.size() != 2 || along.norm() < 0.01 * body_.height())
            fail("the front", "the feet do not point to one side");
        return along;
    }

    /// The legs at a level, left first; empty where two parts alike in size are not found.
    std::vector<SectionLoop> legs_at(double y) const
    {
        constexpr double kAlike = 0.4; // [-] of areas: a knee and a shin; a hand beside the trunk is less
        std::vector<SectionLoop> legs = parts(y);
        if (legs.size() < 2 || legs[1].area < kAlike * legs[0].area)
            return {};
        legs.resize(2);
        if (legs[0].center.x() < legs[1].center.x())
            std::swap(legs[0], legs[1]);
        return legs;
    }
    double middle() const { return middle_; }

    void find_crotch()
    {
        const std::vector<SectionLoop> knees = parts(at_height(0.25));
        middle_ = 0.5 * (knees[0].center.x() + knees[1].center.x());
        const auto are_apart = [&](double y) { return !legs_at(y).empty(); };
        double y = at_height(0.25);
        if (!are_apart(y))
            fail("the crotch", "the legs are not apart at the knees");
        while (y < at_height(0.65) && are_apart(y + step()))
            y += step();
        if (y >= at_height(0.65))
            fail("the crotch", "the legs do not meet");
        y = bisect(y, y + step(), are_apart);
        const std::vector<SectionLoop> legs = legs_at(y);
        const Vec3 inner_left = extreme(legs[kLeft], -Vec3::UnitX());
        const Vec3 inner_right = extreme(legs[kRight], Vec3::UnitX());
        body_.crotch = is_given("crotch") ? given("crotch") : Vec3(0.5 * (inner_left + inner_right));
        for (const Side side : {kLeft, kRight})
            body_.leg[side].top = legs[side].center;
        middle_ = body_.crotch.x();
    }

    static Vec3 extreme(const SectionLoop& loop, const Vec3& direction)
    {
        return *std::max_element(loop.points.begin(), loop.points.end(), [&](const Vec3& a, const Vec3& b) {
            return direction.dot(a) < direction.dot(b);
        });
    }

    void find_leg(Side side)
    {
        // The ankle is thinnest above the joint, at which the slice begins to contain the foot.
        constexpr double kFootBegins = 1.4; // [-] tape over the thinnest
        double thinnest = at_height(0.05), least = 1e300;
        for (double y = at_height(0.04); y < at_height(0.16); y += 0.5 * step())
            if (const double around = leg_tape(side, y); around < least) {
                least = around;
                thinnest = y;
            }
        double y = thinnest;
        while (y > at_height(0.02) && leg_tape(side, y) < kFootBegins * least)
            y -= 0.25 * step();
        const Vec3 center = legs_at(thinnest)[side].center;
        UprightBody::Leg& leg = body_.leg[side];
        leg.ankle = Vec3(center.x(), y, center.z());
        const std::string name = side == kLeft ? "left" : "right";
        if (is_given(name + "_ankle"))
            leg.ankle = given(name + "_ankle");
        if (is_given(name + "_leg_top"))
            leg.top = given(name + "_leg_top");
    }

    double leg_tape(Side side, double y) const
    {
        const std::vector<SectionLoop> legs = legs_at(y);
        if (legs.empty())
            fail("the ankles", "the legs are not apart");
        return tape(legs[side], level(y));
    }

    void find_arm(Side side)
    {
        const std::string name = side == kLeft ? "left" : "right";
        UprightBody::Arm& arm = body_.arm[side];
        const bool is_whole = is_given(name + "_shoulder") && is_given(name + "_wrist");
        if (is_whole) {
            arm.shoulder = arm.shoulder_tip = arm.armpit = given(name + "_shoulder");
            arm.wrist = given(name + "_wrist");
            arm.elbow = 0.5 * (arm.shoulder + arm.wrist);
            return;
        }
        find_armpit(side, name);
        follow_arm(side, name);
        if (is_given(name + "_shoulder"))
            arm.shoulder = given(name + "_shoulder");
        if (is_given(name + "_wrist")) {
            arm.wrist = given(name + "_wrist");
            arm.wrist_axis.setZero();
        }
    }

    /// Width of the trunk to one side at a level.
    double side_width(Side side, double y) const
    {
        const Bounds box = trunk_slice(body_, y).box;
        return side == kLeft ? box.upper.x() - middle() : middle() - box.lower.x();
    }

    /// Below the armpit the slice is the trunk's alone, above it the arm's too. In an A-pose its width jumps
    /// there; in a T-pose the lower side of the arm begins.
    void find_armpit(Side side, const std::string& name)
    {
        constexpr double kWidens = 1.2; // [-] metres of width in a metre of height: no trunk does so
        double low = body_.crotch.y() + 0.12 * body_.height();
        double narrow = side_width(side, low);
        while (low < at_height(0.92)) {
            const double wide = side_width(side, low + step());
            if (wide - narrow > kWidens * step())
                break;
            narrow = wide;
            low += step();
        }
        if (low >= at_height(0.92))
            fail("the " + name + " armpit", "no slice widens to an arm");
        const double jump = 0.03 * body_.height();
        low = bisect(low, low + step(), [&](double y) { return side_width(side, y) < narrow + jump; });
        if (side_width(side, low + 2e-4) - narrow < jump)
            low = std::max(low - step(), body_.crotch.y());
        body_.arm[side].armpit = extreme(trunk_slice(body_, low), outwards(side));
    }

    static Vec3 outwards(Side side) { return side == kLeft ? Vec3(Vec3::UnitX()) : Vec3(-Vec3::UnitX()); }

    /// Slices across the arm from the shoulder to the fingertips.
    void follow_arm(Side side, const std::string& name)
    {
        UprightBody::Arm& arm = body_.arm[side];
        const auto& x = body_.mesh.positions;
        const Vec3 tip = *std::max_element(x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) {
            return outwards(side).dot(a) < outwards(side).dot(b);
        });
        const Vec3 top = arm.armpit + 0.04 * body_.height() * Vec3::UnitY();
        if ((tip - top).norm() < 0.2 * body_.height())
            fail("the " + name + " arm", "nothing lies far enough beside the trunk");

        const auto require_limb = [&](const Slices& part) {
            if (part.center.size() < kSlices / 2)
                fail("the " + name + " arm", "slices across it do not form a limb");
        };
        const Slices whole = slices(top, tip, 0.15, 0.95);
        require_limb(whole);
        const int wrist = whole.end_of_forearm();
        arm.elbow = whole.center[size_t(wrist / 2)];
        const Slices forearm = slices(arm.elbow, whole.center[size_t(wrist)], 0.3, 1.3);
        require_limb(forearm);
        const int thinnest = forearm.end_of_forearm();
        arm.wrist = forearm.center[size_t(thinnest)];
        arm.wrist_axis = (whole.center[size_t(wrist)] - arm.elbow).normalized();
        arm.wrist_tape = forearm.around[size_t(thinnest)];

        // The upper arm's axis, prolonged to above the armpit.
        const Slices upper = slices(top, arm.elbow, 0.4, 0.9);
        require_limb(upper);
        const Vec3 a = upper.center.front(), direction = (upper.center.back() - a).normalized();
        arm.shoulder = a + direction.dot(top - a) * direction;
        find_shoulder_tip(arm);
    }

    static constexpr int kSlices = 64; ///< across a limb

    /// Centres and tapes of slices across a limb.
    struct Slices {
        std::vector<double> at; ///< [-] along the line
        std::vector<Vec3> center;
        std::vector<double> around; ///< [m]

        /// Slice at the wrist: the thinnest before the hand, which is thicker.
        int end_of_forearm() const
        {
            constexpr double kHandBegins = 1.08; // [-] tape over the thinnest
            // From the thickest part of the forearm on.
            const auto middle = around.begin() + long(around.size() / 2);
            auto best = std::max_element(around.begin() + long(around.size() / 3), middle);
            for (auto slice = best; slice != around.end() && *slice < kHandBegins * *best; ++slice)
                if (*slice < *best)
                    best = slice;
            return int(best - around.begin());
        }
    };

    Slices slices(const Vec3& a, const Vec3& b, double from, double to) const
    {
        const double farthest = 0.07 * body_.height();
        Slices result;
        for (int i = 0; i <= kSlices; ++i) {
            const double t = from + (to - from) * i / kSlices;
            const SectionPlane plane = SectionPlane::through(a + t * (b - a), b - a);
            const std::vector<SectionLoop> loops = cut(body_.mesh, plane);
            const auto nearest =
                std::min_element(loops.begin(), loops.end(), [&](const SectionLoop& p, const SectionLoop& q) {
                    return distance(p, plane) < distance(q, plane);
                });
            if (nearest == loops.end() || distance(*nearest, plane) > farthest)
                continue;
            result.at.push_back(t);
            result.center.push_back(nearest->center);
            result.around.push_back(tape(*nearest, plane));
        }
        return result;
    }
    /// Of a loop from the middle of its plane; cavities and fingers count as far.
    double distance(const SectionLoop& loop, const SectionPlane& plane) const
    {
        const bool is_limb = loop.area > 0.6 * kMinArea * body_.height() * body_.height();
        return (loop.center - plane.point).norm() + (is_limb ? 0.0 : body_.height());
    }

    void find_shoulder_tip(UprightBody::Arm& arm) const
    {
        arm.shoulder_tip = arm.shoulder;
        for (const SectionLoop& loop : cut(body_.mesh, SectionPlane::through(arm.armpit, Vec3::UnitX())))
            if (loop.box.lower.y() < arm.shoulder.y() && arm.shoulder.y() < loop.box.upper.y())
                arm.shoulder_tip = extreme(loop, Vec3::UnitY());
    }

    double trunk_width(double y) const { return trunk_slice(body_, y).width(0); }

    void find_neck()
    {
        if (is_given("neck_base") && is_given("neck_top")) {
            body_.neck_base = given("neck_base");
            body_.neck_top = given("neck_top");
            return;
        }
        constexpr double kShouldersBegin = 1.4, kHeadBegins = 1.03; // [-] width over the narrowest
        const double from =
            0.5 * (body_.arm[kLeft].armpit.y() + body_.arm[kRight].armpit.y()) + 0.03 * body_.height();
        const double to = body_.box.upper.y() - 0.08 * body_.height();
        double narrowest = from, least = 1e300;
        for (double y = from; y < to; y += 0.5 * step())
            if (const double width = trunk_width(y); width < least) {
                least = width;
                narrowest = y;
            }
        const auto is_shoulder = [&](double y) { return trunk_width(y) > kShouldersBegin * least; };
        const double top_level =
            bisect(narrowest, to, [&](double y) { return trunk_width(y) < kHeadBegins * least; });
        double y = narrowest;
        while (y > from && !is_shoulder(y - step()))
            y -= step();
        if (y <= from)
            fail("the neck", "slices above the armpits do not widen from a neck to shoulders");
        y = bisect(y - step(), y, is_shoulder);
        const SectionLoop base = trunk_slice(body_, y), top = trunk_slice(body_, top_level);
        body_.neck_base = is_given("neck_base") ? given("neck_base") : base.center;
        // The chin is part of the slice: the neck lies behind it and is about as deep as wide.
        body_.neck_top = Vec3(top.box.center().x(), top_level, top.box.lower.z() + 0.55 * top.width(0));
        if (is_given("neck_top"))
            body_.neck_top = given("neck_top");
    }

    const GivenLandmarks& given_;
    UprightBody body_;
    double middle_ = 0.0; ///< x between the legs
};

} // namespace

BodyLandmarks UprightBody::landmarks() const
{
    const auto world = [this](const Vec3& x) { return Vec3(world_from_body * x); };
    BodyLandmarks result;
    result.front = world_from_body.col(2);
    result.neck_top = world(neck_top);
    result.neck_base = world(neck_base);
    result.crotch = world(crotch);
    for (const Side side : {kLeft, kRight}) {
        result.arm[side] = {world(arm[side].shoulder), world(arm[side].wrist)};
        result.leg[side] = {world(leg[side].top), world(leg[side].ankle)};
    }
    return result;
}

SectionLoop trunk_slice(const UprightBody& body, double y)
{
    const double x = body.crotch.x();
    for (SectionLoop& loop : cut(body.mesh, level(y)))
        if (loop.box.lower.x() < x && x < loop.box.upper.x())
            return std::move(loop);
    throw InvalidInput(body.source + ": has no trunk " + short_text(y - body.box.lower.y()) +
                       " m above its soles; use a body that stands upright");
}

UprightBody find_upright_body(TriangleMesh mesh, const GivenLandmarks& given, const std::string& source)
{
    return Finder(std::move(mesh), given, source).find();
}

} // namespace toile::avatars
