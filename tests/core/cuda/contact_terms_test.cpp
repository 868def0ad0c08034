#include "collision/device_contact_terms.h"

#include <algorithm>
#include <cmath>

#include "collision/contact.h"
#include "collision/host_contact_terms.h"
#include "tests/collision/collider_cases.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/core/cuda/on_device.h"

/// Terms made on a GPU against those of the CPU, step by step from the same positions.
namespace toile::test {
namespace {

constexpr double kDt = 1.0 / 120.0;     // [s]
constexpr double kTermTolerance = 1e-9; // [m], [N/m] and [N] of what terms have besides their pairs

/// Straying that is looked for [m], less than was looked around: whether a place farther away was seen is
/// told by a Clearance, which searches of the CPU leave smaller than they might.
constexpr double kTrust = 0.001;

/// Two sheets around a dented ball that moves, with solids that overlap it, so that some of the cloth is
/// caught between planes that oppose each other; parts of it are held.
struct Dressed {
    static constexpr double kSpacing = 0.0012; // [m] of the sheets

    explicit Dressed(bool moves = true) : random(71), ball(moves)
    {
        ColliderCase made = around_a_ball(random, 48, 4);
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
        partners = {{&*mesh_collider, nullptr},
                    {nullptr, &side},
                    {nullptr, &box},
                    {nullptr, &capsule},
                    {nullptr, &floor}};

        ContactCloth cloth;
        cloth.vertex_count = made.cloth.vertex_count();
        cloth.partner_friction = {0.3, 0.4, 0.5, 0.2, 0.1};
        cloth.cloth_friction = {0.3, 0.6};
        cloths = {cloth, cloth};
        cloths[1].gap = 0.003;
        cloths[1].thickness = 1e-3;
        for (int v = 0; v < int(x.size()); ++v) {
            fixed.push_back(v % 11 == 0);
            diagonal.push_back(100.0 + v % 13);
            masses.push_back(1e-4 * (1.0 + v % 3));
        }
    }

    static void place(ShapeCollider& shape, const Vec3& at)
    {
        const Eigen::Isometry3d pose(Eigen::Translation3d{at});
        shape.move(pose, pose);
    }

    /// The next step: everything moves, cloth goes along and some of it slides.
    void advance()
    {
        const Vec3 way(0.002, -0.001, 0.0015);
        body.x_t0 = body.x_t1;
        for (Vec3& v : body.x_t1)
            v += ball ? Vec3(way + 2e-4 * random.point()) : Vec3(Vec3::Zero());
        mesh_collider->move(body);
        Eigen::Isometry3d turned = side.pose();
        turned.rotate(Eigen::AngleAxisd(0.02, Vec3::UnitZ()));
        turned.pretranslate(Vec3(-0.001, 0.0, 0.0));
        side.move(side.pose(), turned);
        prediction = x;
        found = x;
        for (int v = 0; v < int(x.size()); ++v) {
            const Vec3 jitter = 3e-4 * random.point();
            prediction[v] += way + jitter;
            found[v] = prediction[v] + Vec3(v % 5 == 0 ? slide : 0.0, -0.0005, 0.0);
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
    std::vector<ContactPartner> partners;
    std::vector<ContactCloth> cloths;
    std::vector<double> diagonal, masses;
    std::vector<unsigned char> fixed;
    double slide = 0.002;                   ///< [m] in a step, of some of the cloth
    std::vector<Vec3> x, prediction, found; ///< at t0, guessed, and where the step ends [m]
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
            if (!(std::abs(difference) <= numbers)) // NaN is kept too
                numbers = std::abs(difference);
        gripped += a.give > 0.0;
        remembered += a.normal_force > 0.0;
        between += a.pair.is_between_cloths();
        faces += a.pair.vertex[1] >= 0 && !a.pair.is_between_cloths();
    }
};

class DeviceContactTermsTest : public OnDevice {
protected:
    /// A step's positions on the device.
    struct OnBoard {
        OnBoard(const CudaSpace& space, int count)
            : x(space, "test/x", count), prediction(space, "test/prediction", count),
              found(space, "test/found", count), v(space, "test/v", count), diagonal(space, "test/diagonal"),
              masses(space, "test/masses"), fixed(space, "test/fixed")
        {
        }
        static void fill(MirroredArray<Vec3>& field, View<const Vec3> values)
        {
            std::copy(values.begin(), values.end(), field.overwrite_on_host().begin());
        }
        StepStart begin(const Dressed& made)
        {
            fill(x, made.x);
            fill(prediction, made.prediction);
            fill(found, made.found);
            StepStart start{made.x, made.prediction, made.diagonal, made.fixed, made.masses, kDt};
            diagonal.upload(made.diagonal);
            fixed.upload(made.fixed);
            masses.upload(made.masses);
            start.there = {x.there(), prediction.there(), diagonal.view(), fixed.view(), masses.view()};
            return start;
        }
        MirroredArray<Vec3> x, prediction, found, v;
        DeviceArray<double> diagonal, masses;
        DeviceArray<unsigned char> fixed;
    };

    std::vector<ContactTerm> downloaded(const DeviceContactTerms& terms)
    {
        DeviceArray<ContactTerm> copy(space(), "test/terms", terms.energy().terms().size());
        copy.upload(terms.energy().terms());
        return copy.downloaded();
    }

    /// The same terms in the same order.
    TermDifferences compare(const std::vector<ContactTerm>& here, const std::vector<ContactTerm>& there,
                            const Dressed& made, const std::string& what)
    {
        EXPECT_EQ(here.size(), there.size()) << what;
        const size_t count = std::min(here.size(), there.size());
        ContactDifferences of_pairs;
        for (size_t i = 0; i < count; ++i)
            of_pairs.add(here[i].pair, there[i].pair, made.x);
        EXPECT_EQ(of_pairs.keys, 0) << what;
        EXPECT_EQ(of_pairs.not_finite, 0) << what;
        EXPECT_LT(of_pairs.numbers, kContactTolerance) << what;
        EXPECT_LT(of_pairs.normal, kTermTolerance) << what;
        TermDifferences differences;
        for (size_t i = 0; i < count; ++i)
            differences.add(here[i], there[i]);
        EXPECT_LT(differences.numbers, kTermTolerance) << what;
        return differences;
    }

    /// Both at what lies between two minimisations of a step and at its end.
    void revise(HostContactTerms& here, DeviceContactTerms& there, OnBoard& board, Dressed& made,
                const ClothContact& between, const ClothContact& between_there)
    {
        here.see(made.found);
        there.see(board.found);
        const FrictionLimits expected = here.look_at_forces(), limits = there.look_at_forces();
        EXPECT_GT(expected.total, 0.0);
        EXPECT_NEAR(limits.total, expected.total, 1e-9 * expected.total);
        EXPECT_NEAR(limits.change, expected.change, 1e-9 * expected.total);
        EXPECT_TRUE(here.leaning() == there.leaning());
        EXPECT_NEAR(there.deepest(), here.deepest(), kTermTolerance);
        EXPECT_FALSE(here.has_left(1.0));
        EXPECT_FALSE(there.has_left(1.0));
        EXPECT_TRUE(here.has_left(kTrust));
        EXPECT_TRUE(there.has_left(kTrust));
        here.adopt_forces();
        there.adopt_forces();
        here.remember(RememberedSlip::kByStart);
        there.remember(RememberedSlip::kByStart);
        EXPECT_EQ(there.remembered(), here.remembered());
        here.find_again();
        there.find_again();
        here.make(&between);
        there.make(&between_there);
    }
};

TEST_F(DeviceContactTermsTest, AreThoseOfTheCpuFromStepToStep)
{
    Dressed made;
    const int count = int(made.x.size());
    ContactEnergy energy;
    HostContactTerms here(energy, made.mesh.triangles, made.x, made.cloths, made.partners, made.settings());
    DeviceContactTerms there(space(), made.mesh.triangles, made.x, made.cloths, made.partners,
                             made.settings());
    const std::vector<double> altitude(made.x.size(), 0.005);
    const auto between = make_cloth_contact(made.mesh.triangles, made.x, made.cloths, altitude, nullptr);
    const auto between_there =
        make_cloth_contact(made.mesh.triangles, made.x, made.cloths, altitude, &space());
    OnBoard board(space(), count);
    int gripped = 0, handed_on = 0, with_cloth = 0, faces = 0;
    for (int step = 0; step < 5; ++step) {
        const std::string what = "step " + std::to_string(step);
        made.advance();
        const StepStart start = board.begin(made);
        between->begin_step(start);
        between_there->begin_step(start);
        here.begin_step(start);
        there.begin_step(start);
        between_there->end_search();
        here.make(between.get());
        there.make(between_there.get());
        const TermDifferences first = compare(energy.terms(), downloaded(there), made, what);
        gripped += first.gripped;
        handed_on += first.remembered;
        with_cloth += first.between;
        faces += first.faces;

        revise(here, there, board, made, *between, *between_there);
        const TermDifferences again = compare(energy.terms(), downloaded(there), made, what + " again");
        EXPECT_GT(again.remembered, 10);

        here.remember(RememberedSlip::kSoFar);
        there.remember(RememberedSlip::kSoFar);
        EXPECT_NEAR(there.end_step(), here.end_step(), kTermTolerance);
        made.x = made.found;
    }
    EXPECT_GT(gripped, 10);
    EXPECT_GT(handed_on, 100);
    EXPECT_GT(with_cloth, 100);
    EXPECT_GT(faces, 100);
}

/// Contact as a body asks it.
TEST_F(DeviceContactTermsTest, MoveClothAsOnTheCpu)
{
    Dressed made;
    made.slide = 0.009; // farther than is trusted
    const Contact::Settings settings;
    Contact here(made.mesh.triangles, made.x, made.cloths, made.partners, settings);
    Contact there(made.mesh.triangles, made.x, made.cloths, made.partners, settings, &space());
    OnBoard board(space(), int(made.x.size()));
    const auto expect_same_field = [](View<const Vec3> a, View<const Vec3> b, double tolerance) {
        double most = 0.0;
        for (int v = 0; v < a.size(); ++v)
            most = std::max(most, (a[v] - b[v]).norm());
        EXPECT_LT(most, tolerance);
    };
    for (int step = 0; step < 3; ++step) {
        made.advance();
        const StepStart start = board.begin(made);
        here.begin_step(start);
        there.begin_step(start);
        std::vector<Vec3> guess = made.prediction, x = made.found, v(made.x.size(), Vec3(0.1, -0.3, 0.0));
        EXPECT_TRUE(here.make_feasible(guess));
        EXPECT_TRUE(there.make_feasible(board.prediction));
        expect_same_field(guess, board.prediction.host(), 1e-8);

        EXPECT_TRUE(here.revise(x, true));
        EXPECT_TRUE(there.revise(board.found, true));
        OnBoard::fill(board.v, v);
        here.clear(x, v);
        there.clear(board.found, board.v);
        expect_same_field(x, board.found.host(), 1e-8);
        expect_same_field(v, board.v.host(), 1e-5);
        here.end_step(x);
        there.end_step(board.found);
        EXPECT_GT(here.active_count(), 10);
        EXPECT_EQ(there.active_count(), here.active_count());
        EXPECT_NEAR(there.min_gap(), here.min_gap(), 1e-8);
        made.x = x;
    }
}

/// Far from a mesh and above a floor nothing is launched to look for pairs; come near, they are found.
TEST_F(DeviceContactTermsTest, LookForNothingThatIsBeyondAllCloth)
{
    Dressed made;
    const std::vector<Vec3> there = made.x;
    DeviceContactTerms terms(space(), made.mesh.triangles, made.x, made.cloths, made.partners,
                             made.settings());
    OnBoard board(space(), int(made.x.size()));
    const auto begin_at = [&](const Vec3& offset, Stages& stages) {
        const Stages::Activate activate(stages);
        made.x = there;
        for (Vec3& v : made.x)
            v += offset;
        made.advance();
        terms.begin_step(board.begin(made));
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

/// Nothing near, nothing there, and a mesh that stands still.
TEST_F(DeviceContactTermsTest, AreNoneWhereNothingIsNear)
{
    Dressed made(false);
    for (Vec3& v : made.x)
        v += Vec3(0.0, 5.0, 0.0);
    made.cloths.resize(1);
    made.cloths[0].vertex_count = int(made.x.size());
    Contact contact(made.mesh.triangles, made.x, made.cloths, made.partners, Contact::Settings{}, &space());
    OnBoard board(space(), int(made.x.size()));
    made.advance();
    contact.begin_step(board.begin(made));
    EXPECT_FALSE(contact.make_feasible(board.prediction));
    EXPECT_FALSE(contact.on_device(space())->has_terms());
    EXPECT_FALSE(contact.revise(board.found, true));
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
        DeviceContactTerms terms(space(), made.mesh.triangles, made.x, made.cloths, made.partners,
                                 made.settings());
        OnBoard board(space(), int(made.x.size()));
        for (int step = 0; step < 3; ++step) {
            made.advance();
            terms.begin_step(board.begin(made));
            terms.make(nullptr);
            terms.see(board.found);
            terms.look_at_forces();
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
