#include "collision/contact/cuda/terms.h"

#include <algorithm>
#include <cmath>

#include "collision/contact/contact.h"
#include "collision/contact/cpu/terms.h"
#include "tests/collision/collider_cases.h"
#include "tests/collision/contact/cuda/step_fields.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/core/compute/cuda/on_device.h"

/// Contact terms made on a GPU compared with those of the CPU, step by step from the same positions.
namespace toile::test {

using namespace collision;

namespace {

constexpr double kTermTolerance = 1e-9; // [m], [N/m] and [N] of the numbers of a term besides its pair

/// Threshold of out-of-bounds motion [m], smaller than the searched radius. A Clearance decides for points
/// farther away, and clearances of the CPU's queries are smaller than possible.
constexpr double kTrust = 0.001;

/// Two sheets around a moving dented ball, with solids that overlap it. Opposing planes grip some of the
/// cloth, and parts of it are fixed.
struct Dressed : Fields {
    static constexpr double kSpacing = 0.0012; // [m] of the sheets

    explicit Dressed(bool moves = true) : random(71), ball(moves)
    {
        ColliderCase made = ball_case(random, 48, 4);
        const Vec3 center(0.4, 1.2, -0.3);
        TriangleMesh outer = made.cloth;
        for (Vec3& v : outer.positions)
            v = center + (1.0 + kSpacing / 0.155) * (v - center);
        mesh = testing::merged(made.cloth, outer);
        x = mesh.positions;
        body = {made.mesh.triangles, made.mesh.x_t1, made.mesh.x_t1};
        mesh_collider.emplace(body);
        place(side, center + Vec3(0.25, 0.02, 0.0));
        place(box, center + Vec3(-0.05, 0.19, 0.05));
        place(capsule, center + Vec3(0.0, 0.0, 0.21));
        place(floor, center - Vec3(0.0, 0.1, 0.0));
        colliders = {{&*mesh_collider, nullptr},
                     {nullptr, &side},
                     {nullptr, &box},
                     {nullptr, &capsule},
                     {nullptr, &floor}};

        ContactCloth cloth;
        cloth.vertex_count = made.cloth.vertex_count();
        cloth.collider_friction = {0.3, 0.4, 0.5, 0.2, 0.1};
        cloth.cloth_friction = {0.3, 0.6};
        cloths = {cloth, cloth};
        cloths[1].gap = 0.003;
        cloths[1].thickness = 1e-3;
        add_tables();
    }

    static void place(ShapeCollider& shape, const Vec3& at)
    {
        const Eigen::Isometry3d pose(Eigen::Translation3d{at});
        shape.move(pose, pose);
    }

    /// Advances to the next step: everything moves, cloth follows and some of it slides.
    void advance()
    {
        const Vec3 displacement(0.002, -0.001, 0.0015);
        body.x_t0 = body.x_t1;
        for (Vec3& v : body.x_t1)
            v += ball ? Vec3(displacement + 2e-4 * random.point()) : Vec3(Vec3::Zero());
        mesh_collider->move(body);
        Eigen::Isometry3d rotated = side.pose();
        rotated.rotate(Eigen::AngleAxisd(0.02, Vec3::UnitZ()));
        rotated.pretranslate(Vec3(-0.001, 0.0, 0.0));
        side.move(side.pose(), rotated);
        prediction = x;
        found = x;
        for (int v = 0; v < int(x.size()); ++v) {
            const Vec3 jitter = 3e-4 * random.point();
            prediction[v] += displacement + jitter;
            found[v] = prediction[v] + Vec3(v % 5 == 0 ? kSlide : 0.0, -0.0005, 0.0);
        }
    }

    ContactTerms::Settings settings() const { return {2.0, 1.0, true, true}; }

    Random random;
    bool ball;
    TriangleMesh mesh;
    MovingMesh body;
    std::optional<MeshCollider> mesh_collider;
    ShapeCollider side{SphereShape{0.12}, Eigen::Isometry3d::Identity(), "side"};
    ShapeCollider box{BoxShape{Vec3::Constant(0.05)}, Eigen::Isometry3d::Identity(), "box"};
    ShapeCollider capsule{CapsuleShape{0.1, 0.05}, Eigen::Isometry3d::Identity(), "capsule"};
    ShapeCollider floor{PlaneShape{}, Eigen::Isometry3d::Identity(), "floor"};
    std::vector<ContactCollider> colliders;
    std::vector<ContactCloth> cloths;
    static constexpr double kSlide = 0.002; ///< [m] in a step, of some of the cloth
};

struct TermDifferences {
    double numbers = 0.0;
    int gripped = 0, remembered = 0, between = 0, faces = 0;

    void add(const ContactTerm& a, const ContactTerm& b)
    {
        for (const double difference :
             {a.offset - b.offset, a.spring.stiffness - b.spring.stiffness, a.spring.ramp - b.spring.ramp,
              a.friction - b.friction, a.give - b.give, a.normal_force - b.normal_force,
              a.pressing - b.pressing, (a.anchor - b.anchor).norm()})
            if (!(std::abs(difference) <= numbers)) // true for NaN too
                numbers = std::abs(difference);
        gripped += a.give > 0.0;
        remembered += a.normal_force > 0.0;
        between += a.pair.is_between_cloths();
        faces += a.pair.vertex[1] >= 0 && !a.pair.is_between_cloths();
    }
};

class DeviceContactTermsTest : public OnDevice {
protected:
    std::vector<ContactTerm> downloaded(const DeviceContactTerms& terms)
    {
        DeviceArray<ContactTerm> copy(space(), "test/terms", terms.energy().terms().size());
        copy.upload(terms.energy().terms());
        return copy.downloaded();
    }

    /// Expects the same terms in the same order.
    TermDifferences compare(const std::vector<ContactTerm>& cpu, const std::vector<ContactTerm>& device,
                            const Fields& made, const std::string& what)
    {
        EXPECT_EQ(cpu.size(), device.size()) << what;
        const size_t count = std::min(cpu.size(), device.size());
        ContactDifferences of_pairs;
        for (size_t i = 0; i < count; ++i)
            of_pairs.add(cpu[i].pair, device[i].pair, made.x);
        EXPECT_EQ(of_pairs.keys, 0) << what;
        EXPECT_EQ(of_pairs.not_finite, 0) << what;
        EXPECT_LT(of_pairs.numbers, kContactTolerance) << what;
        EXPECT_LT(of_pairs.normal, kTermTolerance) << what;
        TermDifferences differences;
        for (size_t i = 0; i < count; ++i)
            differences.add(cpu[i], device[i]);
        EXPECT_LT(differences.numbers, kTermTolerance) << what;
        return differences;
    }

    /// Runs the work between two minimisations of a step and at its end on both machines.
    void revise(HostContactTerms& cpu, DeviceContactTerms& device, OnBoard& board, Dressed& made,
                const ClothContact& between, const ClothContact& between_device)
    {
        cpu.see(made.found);
        device.see(board.found);
        const TermSums expected = cpu.update_forces(), limits = device.update_forces();
        EXPECT_GT(expected.total, 0.0);
        EXPECT_NEAR(limits.total, expected.total, 1e-9 * expected.total);
        EXPECT_NEAR(limits.change, expected.change, 1e-9 * expected.total);
        EXPECT_TRUE(cpu.supported() == device.supported());
        EXPECT_NEAR(device.deepest(), cpu.deepest(), kTermTolerance);
        EXPECT_FALSE(cpu.has_left(1.0));
        EXPECT_FALSE(device.has_left(1.0));
        EXPECT_TRUE(cpu.has_left(kTrust));
        EXPECT_TRUE(device.has_left(kTrust));
        cpu.adopt_forces();
        device.adopt_forces();
        cpu.remember(RememberedSlip::kByStart);
        device.remember(RememberedSlip::kByStart);
        EXPECT_EQ(device.remembered(), cpu.remembered());
        cpu.find_again();
        device.find_again();
        cpu.make(&between);
        device.make(&between_device);
    }
};

TEST_F(DeviceContactTermsTest, MatchTheCpuFromStepToStep)
{
    Dressed made;
    const int count = int(made.x.size());
    ContactEnergy energy;
    HostContactTerms cpu(energy, made.mesh.triangles, made.x, made.cloths, made.colliders, made.settings());
    DeviceContactTerms device(space(), made.mesh.triangles, made.x, made.cloths, made.colliders,
                              made.settings());
    const std::vector<double> altitude(made.x.size(), 0.005);
    const auto between =
        make_cloth_contact(made.mesh.triangles, made.x, made.cloths, altitude, {}, true, nullptr);
    const auto between_device =
        make_cloth_contact(made.mesh.triangles, made.x, made.cloths, altitude, {}, true, &space());
    OnBoard board(space(), count);
    int gripped = 0, warm_started = 0, with_cloth = 0, faces = 0;
    for (int step = 0; step < 5; ++step) {
        const std::string what = "step " + std::to_string(step);
        made.advance();
        const StepStart start = board.begin(made);
        between->begin_step(start, cpu);
        between_device->begin_step(start, device);
        cpu.begin_step(start, {});
        device.begin_step(start, {});
        between_device->end_search();
        cpu.make(between.get());
        device.make(between_device.get());
        const TermDifferences first = compare(energy.terms(), downloaded(device), made, what);
        gripped += first.gripped;
        warm_started += first.remembered;
        with_cloth += first.between;
        faces += first.faces;

        revise(cpu, device, board, made, *between, *between_device);
        const TermDifferences again = compare(energy.terms(), downloaded(device), made, what + " again");
        EXPECT_GT(again.remembered, 10);

        cpu.remember(RememberedSlip::kSoFar);
        device.remember(RememberedSlip::kSoFar);
        EXPECT_NEAR(device.end_step(), cpu.end_step(), kTermTolerance);
        made.x = made.found;
    }
    EXPECT_GT(gripped, 10);
    EXPECT_GT(warm_started, 100);
    EXPECT_GT(with_cloth, 100);
    EXPECT_GT(faces, 100);
}

/// Far from a mesh and above a floor no query of pairs is launched; near them, pairs are found.
TEST_F(DeviceContactTermsTest, SkipCollidersFarFromAllCloth)
{
    Dressed made;
    const std::vector<Vec3> start = made.x;
    DeviceContactTerms terms(space(), made.mesh.triangles, made.x, made.cloths, made.colliders,
                             made.settings());
    OnBoard board(space(), int(made.x.size()));
    const auto begin_at = [&](const Vec3& offset, Stages& stages) {
        const Stages::Activate activate(stages);
        made.x = start;
        for (Vec3& v : made.x)
            v += offset;
        made.advance();
        terms.begin_step(board.begin(made), {});
        terms.make(nullptr);
    };
    Stages far, near;
    begin_at(Vec3(0.0, 5.0, 0.0), far);
    EXPECT_EQ(far.calls("collision/device_planes"), 0);
    EXPECT_EQ(far.calls("collision/device_count_shape"), 0);
    EXPECT_TRUE(terms.empty());
    begin_at(Vec3(0.0, 0.0, 0.0), near);
    EXPECT_GT(near.calls("collision/device_planes"), 0);
    EXPECT_GT(near.calls("collision/device_count_shape"), 3);
    EXPECT_FALSE(terms.empty());
}

/// Without nearby colliders there is nothing to query; the mesh is static.
TEST_F(DeviceContactTermsTest, AreEmptyWithoutNearbyColliders)
{
    Dressed made(false);
    for (Vec3& v : made.x)
        v += Vec3(0.0, 5.0, 0.0);
    made.cloths.resize(1);
    made.cloths[0].vertex_count = int(made.x.size());
    Contact contact(made.mesh.triangles, made.x, made.cloths, made.colliders, Contact::Settings{}, &space());
    OnBoard board(space(), int(made.x.size()));
    made.advance();
    contact.begin_step(board.begin(made));
    EXPECT_FALSE(contact.make_feasible(board.prediction));
    EXPECT_FALSE(contact.on_device(space())->has_terms());
    EXPECT_FALSE(contact.revise(board.found, MinimiserProgress::kConverged));
    contact.clear(board.found, board.v);
    contact.end_step(board.found);
    EXPECT_EQ(contact.active_count(), 0);
    EXPECT_EQ(contact.min_gap(), 0.0);
}

TEST_F(DeviceContactTermsTest, HaveTheSameBitsInTwoRuns)
{
    std::vector<ContactTerm> runs[2];
    for (std::vector<ContactTerm>& run : runs) {
        Dressed made;
        DeviceContactTerms terms(space(), made.mesh.triangles, made.x, made.cloths, made.colliders,
                                 made.settings());
        OnBoard board(space(), int(made.x.size()));
        for (int step = 0; step < 3; ++step) {
            made.advance();
            terms.begin_step(board.begin(made), {});
            terms.make(nullptr);
            terms.see(board.found);
            terms.update_forces();
            terms.adopt_forces();
            terms.has_left(kTrust);
            terms.remember(RememberedSlip::kSoFar);
            terms.find_again();
            terms.make(nullptr);
            terms.end_step();
            made.x = made.found;
        }
        run = downloaded(terms);
    }
    ASSERT_EQ(runs[0].size(), runs[1].size());
    int different = 0;
    for (size_t i = 0; i < runs[0].size(); ++i) {
        const ContactTerm &a = runs[0][i], &b = runs[1][i];
        different += a.pair.vertex != b.pair.vertex || a.pair.normal != b.pair.normal ||
                     a.pair.point != b.pair.point || a.anchor != b.anchor || a.offset != b.offset ||
                     a.spring.stiffness != b.spring.stiffness || a.normal_force != b.normal_force;
    }
    EXPECT_EQ(different, 0);
}

} // namespace
} // namespace toile::test
