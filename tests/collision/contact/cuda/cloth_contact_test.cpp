#include <algorithm>

#include "collision/check/find_crossings.h"
#include "collision/contact/cpu/cloth_contact.h"
#include "collision/contact/cuda/cloth_contact.h"
#include "core/base/stages.h"
#include "core/compute/cuda/mirrored_array.h"
#include "tests/collision/cloth_cases.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/collision/self/same_pairs.h"
#include "tests/core/compute/cuda/on_device.h"

/// Contact between cloths on a GPU, compared with the CPU.
namespace toile::test {

using namespace collision;

namespace {

constexpr double kAltitude = 0.007;  // [m] of the triangles of folded_sheet
constexpr double kThickness = 0.003; // [m] distance of its layers
constexpr double kDt = 0.01;         // [s]

/// Max differences between machines of weights and normals of pressing pairs [-], as for near pairs.
constexpr double kTolerance = 1e-9;

/// Field of a step on host and device.
class Field : public MirroredArray<Vec3> {
public:
    Field(const CudaSpace& space, const std::vector<Vec3>& values)
        : MirroredArray(space, "test/field", int(values.size())), space_(space)
    {
        std::copy(values.begin(), values.end(), overwrite_on_host().begin());
    }

    /// Makes the device's values the valid ones, as after a kernel.
    void become_the_devices()
    {
        static_cast<void>(change_on_device());
        space_.synchronise();
    }
    std::vector<Vec3> values() const { return {host().begin(), host().end()}; }

private:
    const CudaSpace& space_;
};

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        if (const double apart = (a[v] - b[v]).norm(); !(apart <= max)) // true for NaN too
            max = apart;
    return max;
}

std::vector<ContactPair> pairs_of(const ClothContact& contact)
{
    std::vector<ContactPair> pairs;
    contact.append_pairs(pairs);
    return pairs;
}

/// Compares entry by entry.
void expect_same_pressing(const std::vector<ContactPair>& cpu, const std::vector<ContactPair>& gpu,
                          const std::string& what)
{
    ASSERT_EQ(cpu.size(), gpu.size()) << what;
    int keys = 0;
    double numbers = 0.0;
    for (size_t i = 0; i < cpu.size(); ++i) {
        keys += int(std::tie(cpu[i].kind, cpu[i].vertex) != std::tie(gpu[i].kind, gpu[i].vertex));
        numbers = std::max(numbers, (cpu[i].normal - gpu[i].normal).norm());
        for (int k = 0; k < 4; ++k)
            numbers = std::max(numbers, std::abs(cpu[i].weight[k] - gpu[i].weight[k]));
    }
    EXPECT_EQ(keys, 0) << what;
    EXPECT_LT(numbers, kTolerance) << what;
}

/// Steps of CPU and GPU from the same start.
struct Sides {
    Sides(const CudaSpace& on, const ClothCase& made)
        : space(on), altitude(made.x.size(), kAltitude), fixed(made.x.size(), 0), ones(made.x.size(), 1.0),
          host(soup(made)), device(space, soup(made))
    {
    }

    ContactSoup soup(const ClothCase& made) const
    {
        return {made.triangles, made.x, {cloth(made)}, altitude, BodySurfaces({}, 0.0), true};
    }

    static ContactCloth cloth(const ClothCase& made)
    {
        ContactCloth cloth;
        cloth.vertex_count = int(made.x.size());
        cloth.thickness = kThickness;
        return cloth;
    }

    void begin_step(const ClothCase& made)
    {
        x = std::make_unique<Field>(space, made.x);
        prediction = std::make_unique<Field>(space, made.expected);
        host.begin_step({x->host(), prediction->host(), ones, fixed, ones, kDt, {}}, no_bodies);
        device.begin_step(
            {{}, {}, ones, fixed, ones, kDt, {}, false, {x->device(), prediction->device(), {}, {}, {}}},
            no_bodies);
        device.end_search();
    }

    struct NoBodies : NearbyBodies {
        View<const Vec3> advect(const StepStart&) override { return {}; }
        View<const NearestSurface> nearest() override { return {}; }
    } no_bodies;
    const CudaSpace& space;
    std::vector<double> altitude;
    std::vector<unsigned char> fixed;
    std::vector<double> ones;
    HostClothContact host;
    DeviceClothContact device;
    std::unique_ptr<Field> x, prediction;
};

class DeviceClothContactTest : public OnDevice {
protected:
    std::vector<ContactPair> downloaded(View<const ContactPair> pairs)
    {
        DeviceArray<ContactPair> copy(space(), "test/pairs");
        copy.upload(pairs);
        return copy.downloaded();
    }
};

const ClothContact::FindSupported kNoneSupported = [] { return std::vector<unsigned char>(); };

TEST_F(DeviceClothContactTest, KeepsThePairsThatAreNotExemptInTheirOrder)
{
    Random random(61);
    const ClothCase made = random_cloth_case(random);
    const int vertices = int(made.x.size());
    std::vector<double> altitude(vertices, kAltitude);
    for (int i = 0; i < 60; ++i)
        altitude[random.below(vertices)] = 1e-4; // slivers, as thin as near layers are apart
    std::vector<unsigned char> crosses(vertices, 0);
    for (int i = 0; i < 100; ++i)
        crosses[random.below(vertices)] = 1;
    const int cloth = vertices / 2; // the others count as bodies
    std::vector<BodyCrossing> crossings;
    crossings.reserve(500);
    std::vector<unsigned char> inside(cloth, 0), released(cloth, 0);
    for (int i = 0; i < 500; ++i)
        crossings.emplace_back(random.below(cloth), cloth + random.below(vertices - cloth));
    for (int i = 0; i < 20; ++i)
        inside[random.below(cloth)] = released[random.below(cloth)] = 1;
    std::vector<Vec3> normals(vertices);
    for (Vec3& n : normals)
        n = random.point().normalized();
    const View<const Vec3> all_normals = normals;
    DeviceNearPairs near(space(), made.triangles, made.x);
    DeviceArray<Vec3> x(space(), "test/x");
    x.upload(made.x);

    for (const bool has_exempt : {false, true}) {
        ExemptPairs exempt(made.x, has_exempt ? altitude : std::vector<double>(vertices, kAltitude), 1e-4);
        DeviceExemptPairs device(space(), exempt);
        if (has_exempt) {
            exempt.set_crossing(crosses);
            exempt.set_body_crossings(crossings);
            exempt.set_inside(inside);
            exempt.set_let_through(released, all_normals.subview(0, cloth),
                                   all_normals.subview(cloth, vertices - cloth));
        }
        const View<const NearPair> found = near.find(x.view(), {}, 0.004);
        std::vector<NearPair> expected(found.size());
        near.download(expected);
        std::erase_if(expected, [&](const NearPair& pair) { return exempt.is_exempt(pair); });
        EXPECT_GT(expected.size(), 1000u);
        EXPECT_EQ(int(expected.size()) < found.size() - 10, has_exempt);

        DeviceArray<NearPair> kept(space(), "test/kept");
        int count = 0;
        device.append_kept(found, kept, count);
        device.append_kept(found, kept, count); // appended behind the first pairs, which stay
        std::vector<NearPair> twice = expected;
        twice.insert(twice.end(), expected.begin(), expected.end());
        std::vector<NearPair> all = kept.downloaded();
        all.resize(count);
        EXPECT_TRUE(are_same_bits(twice, all));
    }
}

TEST_F(DeviceClothContactTest, AcceptsTheSameStepsAsTheCpu)
{
    Random random(62);
    int alone = 0, held = 0, searches = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const ClothCase made = random_cloth_case(random);
        const std::vector<double> altitude(made.x.size(), kAltitude);
        NearPairs near(made.triangles, made.x);
        const ExemptPairs exempt(made.x, altitude, 2e-6);
        CollisionFreeStep free_step(near, exempt, {});
        AsyncNearPairs near_device(space(), made.triangles, made.x);
        DeviceExemptPairs exempt_device(space(), exempt);
        DeviceCollisionFreeStep free_step_device(space(), near_device, exempt_device, free_step.min_gap(),
                                                 int(made.x.size()));

        std::vector<Vec3> motion(made.x.size());
        for (size_t v = 0; v < motion.size(); ++v)
            motion[v] = made.expected[v] - made.x[v];
        std::vector<NearPair> pairs;
        const double margin = CollisionFreeStep::Settings{}.thickness;
        near.find(made.x, {motion, made.slack}, margin, pairs);
        const std::vector<unsigned char> free(made.x.size(), 0);
        free_step.begin(made.x, made.expected, made.slack, free, pairs);

        Field x(space(), made.x), expected(space(), made.expected), wanted(space(), made.wanted);
        DeviceArray<Vec3> motion_device(space(), "test/motion");
        DeviceArray<double> slack(space(), "test/slack");
        motion_device.upload(motion);
        slack.upload(made.slack);
        near_device.begin(x.device(), {motion_device.view(), slack.view()}, margin);
        free_step_device.begin(x.device(), expected.device(), slack.view(), near_device.end());
        DeviceArray<NearPair> listed(space(), "test/listed");
        listed.upload(free_step_device.pairs());
        expect_same(pairs, listed.downloaded(), "of trial " + std::to_string(trial));

        Stages stages;
        const Stages::Activate activate(stages);
        std::vector<Vec3> limited = made.wanted;
        const bool is_free = free_step.limit(limited) == 0.0;
        const long cpu_searches = stages.calls("collision/search_again");
        EXPECT_EQ(free_step_device.query_all(wanted.device()).empty(), is_free) << trial;
        const long gpu_searches = stages.calls("collision/search_again") - cpu_searches;
        EXPECT_LE(gpu_searches, cpu_searches) << trial;
        searches += int(gpu_searches);
        EXPECT_EQ(free_step_device.query_all(wanted.device()).empty(), is_free)
            << trial; // out-of-bounds vertices are known here
        EXPECT_TRUE(free_step_device.query_all(x.device()).empty()) << trial;
        (is_free ? alone : held)++;
    }
    EXPECT_GE(alone, 15);
    EXPECT_GE(held, 15);
    EXPECT_GE(searches, 5);
}

TEST_F(DeviceClothContactTest, StepsAsOnTheCpu)
{
    Random random(63);
    int pressing = 0, found_again = 0, limited_count = 0;
    for (int trial = 0; trial < 8; ++trial) {
        ClothCase made = random_cloth_case(random);
        Sides sides(space(), made);
        for (int step = 0; step < 4; ++step) {
            const std::string what = "trial " + std::to_string(trial) + " step " + std::to_string(step);
            sides.begin_step(made);
            expect_same_pressing(pairs_of(sides.host), pairs_of(sides.device), what);
            EXPECT_TRUE(are_same_bits(pairs_of(sides.device), downloaded(sides.device.pressing_on_device())));
            pressing += sides.device.pressing_on_device().size();

            std::vector<Vec3> x = made.wanted, v(x.size(), Vec3::UnitX());
            Field x_device(space(), x), v_device(space(), v);
            x_device.become_the_devices();
            v_device.become_the_devices();
            const bool is_new = sides.host.advance(x, kNoneSupported);
            EXPECT_EQ(sides.device.advance(x_device, kNoneSupported), is_new) << what;
            EXPECT_LT(max_distance(x, x_device.values()), 1e-11) << what;
            expect_same_pressing(pairs_of(sides.host), pairs_of(sides.device), what + ", advanced");
            found_again += int(is_new);

            for (Vec3& p : x)
                p += 2e-4 * random.point();
            std::copy(x.begin(), x.end(), x_device.overwrite_on_host().begin());
            x_device.become_the_devices();
            const bool is_far = sides.host.limit_motion(x, v, kDt, kNoneSupported);
            EXPECT_EQ(sides.device.limit_motion(x_device, v_device, kDt, kNoneSupported), is_far) << what;
            EXPECT_LT(max_distance(x, x_device.values()), 1e-11) << what;
            EXPECT_LT(max_distance(v, v_device.values()), 1e-11 / kDt) << what;
            limited_count += int(v != std::vector<Vec3>(v.size(), Vec3::UnitX()));

            std::copy(x.begin(), x.end(), x_device.overwrite_on_host().begin());
            sides.host.end_step(x);
            sides.device.end_step(x_device);
            for (size_t i = 0; i < x.size(); ++i) {
                const Vec3 move = x[i] - made.x[i];
                made.x[i] = x[i];
                made.expected[i] = x[i] + move;
                made.wanted[i] = made.expected[i] + 1e-4 * random.point();
            }
        }
    }
    EXPECT_GT(pressing, 1000);
    EXPECT_GT(found_again, 4);
    EXPECT_GT(limited_count, 4);
}

TEST_F(DeviceClothContactTest, CopiesNothingToTheHostInFreeSteps)
{
    Random random(64);
    ClothCase made = random_cloth_case(random);
    for (size_t v = 0; v < made.x.size(); ++v) // common motion; one vertex deviates
        made.wanted[v] = made.expected[v] = made.x[v] + Vec3(0.1, -0.2, 0.0);
    made.wanted[5].x() -= 0.001;
    Sides sides(space(), made);
    sides.begin_step(made);
    Field x(space(), made.wanted), v(space(), made.wanted);
    x.become_the_devices();
    v.become_the_devices();
    const auto find_supported = []() -> std::vector<unsigned char> {
        ADD_FAILURE() << "which cloth is supported does not matter";
        return {};
    };
    Stages stages;
    const Stages::Activate activate(stages);
    EXPECT_FALSE(sides.device.advance(x, find_supported));
    EXPECT_FALSE(sides.device.limit_motion(x, v, kDt, find_supported));
    sides.device.end_step(x);
    EXPECT_FALSE(x.is_on_host());
    EXPECT_FALSE(v.is_on_host());
    EXPECT_EQ(stages.calls("collision/search_again"), 1);
    EXPECT_EQ(stages.calls("collision/collision_free_step_to_host"), 0);
    EXPECT_EQ(x.values(), made.wanted);
}

TEST_F(DeviceClothContactTest, HasTheSameBitsEveryTime)
{
    Random random(65);
    const ClothCase made = random_cloth_case(random);
    Sides first(space(), made), second(space(), made);
    first.begin_step(made);
    second.begin_step(made);
    EXPECT_GT(first.device.pressing_on_device().size(), 10);
    EXPECT_TRUE(are_same_bits(pairs_of(first.device), pairs_of(second.device)));
}

TEST_F(DeviceClothContactTest, ForgetsRepositionedCloth)
{
    Random random(66);
    const ClothCase made = random_cloth_case(random);
    Sides sides(space(), made), fresh(space(), made);
    sides.begin_step(made);
    Field x(space(), made.wanted);
    sides.device.end_step(x);
    sides.device.forget();
    sides.begin_step(made);
    fresh.begin_step(made);
    EXPECT_TRUE(are_same_bits(pairs_of(sides.device), pairs_of(fresh.device)));
}

/// Flat sheet of `side` x `side` vertices.
ClothCase flat_case(int side)
{
    ClothCase made;
    for (int v = 0; v < side * side; ++v)
        made.x.emplace_back(0.01 * (v % side), 0.0, 0.01 * (v / side));
    for (int v = 0; v < side * (side - 1); ++v)
        if (v % side + 1 < side) {
            made.triangles.push_back({v, v + side, v + 1});
            made.triangles.push_back({v + 1, v + side, v + side + 1});
        }
    made.expected = made.wanted = made.x;
    made.slack.assign(made.x.size(), 3e-4);
    return made;
}

/// Every vertex flies far through all others, as from a minimiser that has lost its way. A triangle far off
/// may be fixed, and led to its target.
TEST_F(DeviceClothContactTest, TakesBackMotionThatSweepsThroughTooMuch)
{
    Random random(65);
    ClothCase made = flat_case(40);
    for (Vec3& end : made.expected)
        end += 5.0 * random.point();
    const int led = int(made.x.size());
    for (const Vec3& corner : {Vec3(100.0, 0.0, 0.0), Vec3(100.0, 0.0, 0.01), Vec3(100.01, 0.0, 0.0)})
        made.x.push_back(corner);
    made.triangles.push_back({led, led + 1, led + 2});
    for (int v = led; v < led + 3; ++v)
        made.expected.push_back(made.x[v] + Vec3(0.0, 0.002, 0.0));
    made.wanted = made.x;
    made.slack.resize(made.x.size(), made.slack[0]);
    std::vector<Vec3> motion;
    for (size_t v = 0; v < made.x.size(); ++v)
        motion.push_back(made.expected[v] - made.x[v]);
    DeviceArray<Vec3> start(space(), "test/x"), flight(space(), "test/motion");
    DeviceArray<double> slack(space(), "test/slack");
    start.upload(made.x);
    flight.upload(motion);
    slack.upload(made.slack);
    DeviceNearPairs near(space(), made.triangles, made.x);
    ASSERT_THROW(near.find(start.view(), {flight.view(), slack.view()}, kThickness), TooManyPairs);

    for (const bool has_fixed : {false, true}) {
        Sides sides(space(), made);
        std::fill_n(sides.fixed.end() - 3, 3, has_fixed);
        Field x(space(), made.x), prediction(space(), made.expected), end(space(), made.expected);
        Field velocity(space(), std::vector<Vec3>(made.x.size(), Vec3::Zero()));
        sides.device.begin_step({{},
                                 {},
                                 sides.ones,
                                 sides.fixed,
                                 sides.ones,
                                 kDt,
                                 {},
                                 false,
                                 {x.device(), prediction.device(), {}, {}, {}}},
                                sides.no_bodies);
        sides.device.end_search();
        EXPECT_TRUE(sides.device.limit_motion(end, velocity, kDt, kNoneSupported));
        const std::vector<Vec3> reached = end.values(), change = velocity.values();
        EXPECT_EQ(find_crossings(made.triangles, reached).size(), 0u);
        double moved = 0.0;
        for (size_t v = 0; v < reached.size(); ++v) {
            moved = std::max(moved, (reached[v] - made.x[v]).norm());
            EXPECT_LT((change[v] - (reached[v] - made.expected[v]) / kDt).norm(), 1e-9);
        }
        EXPECT_GT(moved, 1e-5);
        const double led_by = (reached[led] - made.x[led]).norm();
        if (has_fixed)
            EXPECT_NEAR(led_by, 0.002, 1e-9);
        else
            EXPECT_LT(led_by, 0.0011);
    }
}

} // namespace
} // namespace toile::test
