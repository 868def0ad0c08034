#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "collision/check/find_crossings.h"
#include "collision/contact/contact.h"
#include "collision/contact/cpu/terms.h"
#include "collision/contact/cuda/terms.h"
#include "tests/collision/contact/cuda/step_fields.h"
#include "tests/collision/soups.h"
#include "tests/core/compute/cuda/on_device.h"

/// Bodies in the collision-free step on a GPU, compared with the CPU.
namespace toile::test {

using namespace collision;

namespace {

/// [m] of gaps at the end of a step
constexpr double kTermTolerance = 1e-9;

/// Two sheets that a box presses on from above and a capsule passes below, beside an open plate that faces
/// down. None crosses another at the start.
struct Swept : Fields {
    static constexpr int kSide = 16;
    static constexpr double kEdge = 0.02; // [m]

    Swept()
    {
        for (const double height : {0.0, -0.004}) {
            Soup sheet;
            add_sheet(sheet, kSide, kEdge, height);
            const int first = int(x.size());
            for (const Triangle& t : sheet.triangles)
                triangles.push_back(t + Triangle::Constant(first));
            for (const Vec3& at : sheet.x)
                x.push_back(at + 1e-4 * random.point());
        }
        place(box, Vec3(0.1, 0.033, 0.1));
        place(capsule, Vec3(0.22, -0.03, 0.2));
        colliders = {{nullptr, &box}, {nullptr, &capsule}, {&plate, nullptr}};
        ContactCloth cloth;
        cloth.vertex_count = kSide * kSide;
        cloth.collider_friction = {0.3, 0.4, 0.5};
        cloth.cloth_friction = {0.3, 0.6};
        cloths = {cloth, cloth};
        add_tables();
        fixed.assign(x.size(), 0);
    }

    /// Its axis, if it has one, along x.
    static void place(ShapeCollider& shape, const Vec3& at)
    {
        Eigen::Isometry3d pose(Eigen::Translation3d{at});
        pose.rotate(Eigen::AngleAxisd(0.5 * EIGEN_PI, Vec3::UnitZ()));
        shape.move(pose, pose);
    }

    static MovingMesh plate_mesh()
    {
        const std::vector<Vec3> corners{Vec3(0.2, -0.008, 0.0), Vec3(0.36, -0.008, 0.0),
                                        Vec3(0.36, -0.008, 0.12), Vec3(0.2, -0.008, 0.12)};
        return {{{0, 1, 2}, {0, 2, 3}}, corners, corners};
    }

    /// Moves the bodies by a step; cloth would stay.
    void advance(const Vec3& of_box, const Vec3& of_capsule)
    {
        const auto move = [](ShapeCollider& shape, const Vec3& by) {
            Eigen::Isometry3d next = shape.pose();
            next.pretranslate(by);
            shape.move(shape.pose(), next);
        };
        move(box, of_box);
        move(capsule, of_capsule);
        prediction = x;
        for (Vec3& at : prediction)
            at += Vec3(0.0, -2e-4, 0.0) + 1e-4 * random.point();
        found = prediction;
    }

    int crossings() const
    {
        const BodySurfaces bodies(colliders, 0.25 * largest_gap(cloths)); // as in make_cloth_contact
        std::vector<Vec3> at(bodies.vertex_count());
        bodies.pose_t1(at);
        return int(find_crossings(triangles, x, bodies.triangles(), at).size() +
                   find_crossings(triangles, x).size());
    }

    Random random{72};
    std::vector<Triangle> triangles;
    ShapeCollider box{BoxShape{Vec3(0.03, 0.04, 0.04)}, Eigen::Isometry3d::Identity(), "box"};
    ShapeCollider capsule{CapsuleShape{0.1, 0.02}, Eigen::Isometry3d::Identity(), "capsule"};
    MeshCollider plate{plate_mesh()};
    std::vector<ContactCollider> colliders;
    std::vector<ContactCloth> cloths;
};

/// Kinds among terms.
int count_of(const std::vector<ContactTerm>& terms, ContactKind kind)
{
    return int(std::count_if(terms.begin(), terms.end(),
                             [&](const ContactTerm& term) { return term.pair.kind == kind; }));
}

double max_distance(View<const Vec3> a, View<const Vec3> b)
{
    double max = a.size() == b.size() ? 0.0 : 1.0;
    for (int v = 0; v < std::min(a.size(), b.size()); ++v)
        max = std::max(max, (a[v] - b[v]).norm());
    return max;
}

class DeviceContactBodiesTest : public OnDevice {
protected:
    std::vector<ContactTerm> downloaded(const DeviceContactTerms& terms)
    {
        DeviceArray<ContactTerm> copy(space(), "test/terms", terms.energy().terms().size());
        copy.upload(terms.energy().terms());
        return copy.downloaded();
    }
};

/// Contact with the calls of a body.
TEST_F(DeviceContactBodiesTest, MoveClothAsOnTheCpu)
{
    Swept made;
    Swept::place(made.box, Vec3(0.1, 0.0315, 0.1)); // nearer than the gap
    const Contact::Settings settings;
    Contact cpu(made.triangles, made.x, made.cloths, made.colliders, settings);
    Contact device(made.triangles, made.x, made.cloths, made.colliders, settings, &space());
    OnBoard board(space(), int(made.x.size()));
    const auto expect_same_field = [](View<const Vec3> a, View<const Vec3> b, double tolerance) {
        double max_difference = 0.0;
        for (int v = 0; v < a.size(); ++v)
            max_difference = std::max(max_difference, (a[v] - b[v]).norm());
        EXPECT_LT(max_difference, tolerance);
    };
    made.advance(Vec3(0.0, -0.001, 0.0), Vec3(0.0, 0.001, 0.0));
    for (Vec3& end : made.found)
        end += Vec3(0.009, -0.0005, 0.0); // farther than kTrust
    const StepStart start = board.begin(made);
    cpu.begin_step(start);
    device.begin_step(start);
    std::vector<Vec3> guess = made.prediction, x = made.found, v(made.x.size(), Vec3(0.1, -0.3, 0.0));
    EXPECT_TRUE(cpu.make_feasible(guess));
    OnBoard::fill(board.v, made.prediction); // the prediction itself is borrowed
    EXPECT_TRUE(device.make_feasible(board.v));
    expect_same_field(guess, board.v.host(), 1e-8);

    EXPECT_TRUE(cpu.revise(x, MinimiserProgress::kConverged));
    EXPECT_TRUE(device.revise(board.found, MinimiserProgress::kConverged));
    OnBoard::fill(board.v, v);
    cpu.clear(x, v);
    device.clear(board.found, board.v);
    expect_same_field(x, board.found.host(), 1e-8);
    expect_same_field(v, board.v.host(), 1e-5);
    cpu.end_step(x);
    device.end_step(board.found);
    EXPECT_GT(cpu.active_count(), 10);
    EXPECT_EQ(device.active_count(), cpu.active_count());
    EXPECT_NEAR(device.min_gap(), cpu.min_gap(), 1e-8);
}

/// Contact with bodies of the collision-free step on both machines.
struct BothSides {
    BothSides(const CudaSpace& space, Swept& of)
        : made(of), cpu(energy, of.triangles, of.x, of.cloths, of.colliders, {2.0, 1.0, true, true}),
          device(space, of.triangles, of.x, of.cloths, of.colliders, {2.0, 1.0, true, true}),
          between(make_cloth_contact(of.triangles, of.x, of.cloths, altitude, of.colliders, true, nullptr)),
          between_device(
              make_cloth_contact(of.triangles, of.x, of.cloths, altitude, of.colliders, true, &space))
    {
    }

    void begin_step(const StepStart& start)
    {
        between->begin_step(start, cpu);
        between_device->begin_step(start, device);
        cpu.begin_step(start, between->carried());
        device.begin_step(start, between_device->carried());
        between_device->end_search();
        make();
    }
    void make()
    {
        cpu.make(between.get());
        device.make(between_device.get());
    }

    /// Expects the same terms, up to rounding of pairs that are carried to some micrometres from each other.
    void compare(const std::vector<ContactTerm>& of_device, const std::string& what) const
    {
        using Key = std::tuple<ContactKind, int, int, std::array<int, 4>>;
        const auto key_of = [](const ContactPair& p) { return Key(p.kind, p.collider, p.feature, p.vertex); };
        std::map<Key, const ContactTerm*> known;
        for (const ContactTerm& term : energy.terms())
            known[key_of(term.pair)] = &term;
        int missing = int(energy.terms().size());
        double numbers = 0.0, normal = 0.0;
        for (const ContactTerm& b : of_device) {
            const auto found = known.find(key_of(b.pair));
            if (found == known.end())
                continue;
            --missing;
            const ContactTerm& a = *found->second;
            normal = std::max(normal, (a.pair.normal - b.pair.normal).norm());
            for (const double difference :
                 {(a.pair.point - b.pair.point).norm(), (a.pair.motion - b.pair.motion).norm(),
                  a.offset - b.offset, a.friction - b.friction, (a.anchor - b.anchor).norm()})
                numbers = std::max(numbers, std::abs(difference));
        }
        EXPECT_LE(std::abs(missing), 2) << what;
        EXPECT_LE(std::abs(int(of_device.size()) - int(known.size())), 2) << what;
        EXPECT_LT(numbers, 1e-7) << what;
        EXPECT_LT(normal, 1e-4) << what;
    }

    Swept& made;
    const std::vector<double> altitude = std::vector<double>(made.x.size(), 0.014);
    ContactEnergy energy;
    HostContactTerms cpu;
    DeviceContactTerms device;
    std::unique_ptr<ClothContact> between, between_device;
};

/// Bodies carry cloth along, guards keep its side, and no trajectory crosses a body.
TEST_F(DeviceContactBodiesTest, KeepClothOffBodiesAsOnTheCpu)
{
    Swept made;
    BothSides sides(space(), made);
    OnBoard board(space(), int(made.x.size()));
    int guards = 0, two_sided = 0, carried = 0, limited = 0;
    int different = 0; // steps in which rounding has decided whether a pair blocks the carried cloth
    for (int step = 0; step < 10; ++step) {
        const std::string what = "step " + std::to_string(step);
        const bool is_moving = step < 7;
        made.advance(is_moving ? Vec3(0.001, -0.003, 0.0) : Vec3(Vec3::Zero()),
                     is_moving ? Vec3(-0.001, 0.002, 0.001) : Vec3(Vec3::Zero()));
        sides.begin_step(board.begin(made));
        const View<const Vec3> at = sides.between->carried();
        ASSERT_EQ(sides.between_device->carried().size(), at.size()) << what;
        EXPECT_EQ(at.size(), is_moving ? int(made.x.size()) : 0) << what;
        bool is_same = true;
        if (is_moving) {
            DeviceArray<Vec3> copy(space(), "test/carried");
            copy.upload(sides.between_device->carried());
            is_same = max_distance(at, copy.downloaded()) < 1e-9;
            different += is_same ? 0 : 1;
            carried += max_distance(at, made.x) > 0.002;
        }
        const std::vector<ContactTerm> terms = downloaded(sides.device);
        if (is_same)
            sides.compare(terms, what);
        guards += count_of(terms, ContactKind::kGuard);
        two_sided += count_of(terms, ContactKind::kTwoSided);

        // The minimiser's result: cloth that would press into the bodies.
        made.found.assign(at.begin(), at.end());
        if (!is_moving)
            made.found = made.x;
        for (Vec3& end : made.found)
            end += Vec3(0.0, 0.004 * std::sin(40.0 * end.x()), 0.0) + 1e-4 * made.random.point();
        OnBoard::fill(board.found, made.found);
        OnBoard::fill(board.v, made.prediction);
        std::vector<Vec3> v = made.prediction;
        sides.cpu.see(made.found);
        sides.device.see(board.found);
        const auto supported = [&] { return sides.cpu.supported(); };
        const auto supported_on_device = [&] { return sides.device.supported(); };
        EXPECT_EQ(sides.between->advance(made.found, supported),
                  sides.between_device->advance(board.found, supported_on_device))
            << what;
        EXPECT_LT(max_distance(made.found, board.found.host()), 1e-7) << what;
        sides.make();
        if (is_same)
            sides.compare(downloaded(sides.device), what + " again");
        for (Vec3& end : made.found)
            end += 2e-4 * made.random.point();
        const std::vector<Vec3> wanted = made.found;
        OnBoard::fill(board.found, made.found);
        EXPECT_EQ(sides.between->limit_motion(made.found, v, kDt, supported),
                  sides.between_device->limit_motion(board.found, board.v, kDt, supported_on_device))
            << what;
        EXPECT_LT(max_distance(made.found, board.found.host()), 1e-7) << what;
        EXPECT_LT(max_distance(v, board.v.host()), 1e-7 / kDt) << what;
        limited += made.found != wanted;
        OnBoard::fill(board.found, made.found);

        sides.cpu.see(made.found);
        sides.device.see(board.found);
        EXPECT_NEAR(sides.device.end_step(), sides.cpu.end_step(), kTermTolerance);
        sides.between->end_step(made.found);
        sides.between_device->end_step(board.found);
        made.x = made.found;
        EXPECT_EQ(made.crossings(), 0) << what;
    }
    EXPECT_GT(guards, 100);
    EXPECT_GT(two_sided, 10);
    EXPECT_LE(different, 2);
    EXPECT_GT(carried, 2);
    EXPECT_GT(limited, 2);
}

/// Box and capsule close on the sheets until they overlap.
TEST_F(DeviceContactBodiesTest, LetBodiesThroughAsOnTheCpu)
{
    Swept made;
    Swept::place(made.capsule, Vec3(0.1, -0.03, 0.1));
    BothSides sides(space(), made);
    OnBoard board(space(), int(made.x.size()));
    int let_through = 0;
    for (int step = 0; step < 7; ++step) {
        const std::string what = "step " + std::to_string(step);
        const double way = step == 0 ? 0.0 : 0.003;
        made.advance(Vec3(0.0, -way, 0.0), Vec3(0.0, way, 0.0));
        sides.begin_step(board.begin(made));
        const ContactBodies &cpu = sides.between->bodies(), &device = sides.between_device->bodies();
        EXPECT_EQ(device.let_through().count(), cpu.let_through().count()) << what;
        EXPECT_EQ(device.stuck_count(), cpu.stuck_count()) << what;
        const View<const unsigned char> expected = cpu.let_through().released(),
                                        released = device.let_through().released();
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), released.begin())) << what;
        sides.compare(downloaded(sides.device), what);
        let_through = cpu.let_through().count();
        if (const View<const Vec3> at = sides.between->carried(); !at.empty())
            made.x.assign(at.begin(), at.end());
        sides.cpu.see(made.x);
        OnBoard::fill(board.found, made.x);
        sides.device.see(board.found);
        sides.cpu.end_step();
        sides.device.end_step();
        sides.between->end_step(made.x);
        sides.between_device->end_step(board.found);
    }
    EXPECT_GT(let_through, 5);
}

/// Bodies that stand are not looked at on the host.
TEST_F(DeviceContactBodiesTest, CopyNothingWhileBodiesStand)
{
    Swept made;
    BothSides sides(space(), made);
    OnBoard board(space(), int(made.x.size()));
    Stages stages;
    for (int step = 0; step < 3; ++step) {
        const Stages::Activate activate(stages);
        made.advance(Vec3::Zero(), Vec3::Zero());
        sides.begin_step(board.begin(made));
        EXPECT_EQ(stages.calls("collision/bodies_on_host"), 1) << "in the first step only";
    }
}

} // namespace
} // namespace toile::test
