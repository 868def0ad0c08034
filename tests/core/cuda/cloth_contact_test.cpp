#include <algorithm>

#include "collision/cloth/device_cloth_contact.h"
#include "collision/cloth/host_cloth_contact.h"
#include "core/backend/stages.h"
#include "tests/collision/cloth_cases.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/collision/same_pairs.h"
#include "tests/core/cuda/on_device.h"

/// Cloth against cloth on a GPU against the same on the CPU.
namespace toile::test {
namespace {

constexpr double kAltitude = 0.007;  // [m] of the triangles of folded_sheet
constexpr double kThickness = 0.003; // [m] as far as its layers are apart
constexpr double kDt = 0.01;         // [s]

/// Largest differences between machines of the weights and normals of pairs that press [-], as of near pairs.
constexpr double kTolerance = 1e-9;

/// A field of a step, on both sides.
class Field : public MirroredArray<Vec3> {
public:
    Field(const CudaSpace& space, const std::vector<Vec3>& values)
        : MirroredArray(space, "test/field", int(values.size())), space_(space)
    {
        std::copy(values.begin(), values.end(), overwrite_on_host().begin());
    }

    /// As a kernel leaves it: the host has not seen it.
    void become_the_devices()
    {
        static_cast<void>(change_there());
        space_.synchronise();
    }
    std::vector<Vec3> values() const { return {host().begin(), host().end()}; }

private:
    const CudaSpace& space_;
};

double farthest_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double most = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        if (const double apart = (a[v] - b[v]).norm(); !(apart <= most)) // NaN is kept too
            most = apart;
    return most;
}

std::vector<ContactPair> pairs_of(const ClothContact& contact)
{
    std::vector<ContactPair> pairs;
    contact.append_pairs(pairs);
    return pairs;
}

/// Entry by entry.
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

/// Both sides of a step, which begin at the same.
struct Sides {
    Sides(const CudaSpace& on, const ClothCase& made)
        : space(on), altitude(made.x.size(), kAltitude), fixed(made.x.size(), 0), ones(made.x.size(), 1.0),
          host(made.triangles, made.x, {cloth(made)}, altitude),
          there(space, made.triangles, made.x, {cloth(made)}, altitude)
    {
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
        host.begin_step({x->host(), prediction->host(), ones, fixed, ones, kDt, {}});
        there.begin_step({{}, {}, ones, fixed, ones, kDt, {x->there(), prediction->there(), {}, {}, {}}});
        there.end_search();
    }

    const CudaSpace& space;
    std::vector<double> altitude;
    std::vector<unsigned char> fixed;
    std::vector<double> ones;
    HostClothContact host;
    DeviceClothContact there;
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

const ClothContact::Leaning kLeansNowhere = [] { return std::vector<unsigned char>(); };

TEST_F(DeviceClothContactTest, KeepsThePairsThatAreNotExemptInTheirOrder)
{
    Random random(61);
    const ClothCase made = random_cloth_case(random);
    const int vertices = int(made.x.size());
    std::vector<double> altitude(vertices, kAltitude);
    for (int i = 0; i < 60; ++i)
        altitude[random.below(vertices)] = 1e-4; // slivers, as far as near ones are apart
    std::vector<unsigned char> crosses(vertices, 0);
    for (int i = 0; i < 100; ++i)
        crosses[random.below(vertices)] = 1;
    DeviceNearPairs near(space(), made.triangles, made.x);
    DeviceArray<Vec3> x(space(), "test/x");
    x.upload(made.x);

    for (const bool has_exempt : {false, true}) {
        ExemptPairs exempt(made.x, has_exempt ? altitude : std::vector<double>(vertices, kAltitude), 1e-4);
        DeviceExemptPairs there(space(), exempt);
        if (has_exempt) {
            exempt.set_crossing(crosses);
            there.set_crossing(crosses);
        }
        const View<const NearPair> found = near.find(x.view(), {}, 0.004);
        std::vector<NearPair> expected(found.size());
        near.download(expected);
        std::erase_if(expected, [&](const NearPair& pair) { return exempt.is_exempt(pair); });
        EXPECT_GT(expected.size(), 1000u);
        EXPECT_EQ(int(expected.size()) < found.size() - 10, has_exempt);

        DeviceArray<NearPair> kept(space(), "test/kept");
        int count = 0;
        there.append_kept(found, kept, count);
        there.append_kept(found, kept, count); // behind the first ones, which stay
        std::vector<NearPair> twice = expected;
        twice.insert(twice.end(), expected.begin(), expected.end());
        std::vector<NearPair> all = kept.downloaded();
        all.resize(count);
        EXPECT_TRUE(are_same_bits(twice, all));
    }
}

TEST_F(DeviceClothContactTest, LeavesAloneWhatTheCpuLeavesAlone)
{
    Random random(62);
    int alone = 0, held = 0, looked = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const ClothCase made = random_cloth_case(random);
        const std::vector<double> altitude(made.x.size(), kAltitude);
        NearPairs near(made.triangles, made.x);
        const ExemptPairs exempt(made.x, altitude, 2e-6);
        SafeStep safe(near, exempt, {});
        AsyncNearPairs near_there(space(), made.triangles, made.x);
        DeviceExemptPairs exempt_there(space(), exempt);
        DeviceSafeStep safe_there(space(), near_there, exempt_there, safe.least_gap(), int(made.x.size()));

        std::vector<Vec3> motion(made.x.size());
        for (size_t v = 0; v < motion.size(); ++v)
            motion[v] = made.expected[v] - made.x[v];
        std::vector<NearPair> pairs;
        const double margin = SafeStep::Settings{}.thickness;
        near.find(made.x, {motion, made.slack}, margin, pairs);
        const std::vector<unsigned char> free(made.x.size(), 0);
        safe.begin(made.x, made.expected, made.slack, free, pairs);

        Field x(space(), made.x), expected(space(), made.expected), wanted(space(), made.wanted);
        DeviceArray<Vec3> motion_there(space(), "test/motion");
        DeviceArray<double> slack(space(), "test/slack");
        motion_there.upload(motion);
        slack.upload(made.slack);
        near_there.begin(x.there(), {motion_there.view(), slack.view()}, margin);
        safe_there.begin(x.there(), expected.there(), slack.view(), near_there.end());
        DeviceArray<NearPair> listed(space(), "test/listed");
        listed.upload(safe_there.pairs());
        expect_same(pairs, listed.downloaded(), "of trial " + std::to_string(trial));

        Stages stages;
        const Stages::Activate activate(stages);
        std::vector<Vec3> limited = made.wanted;
        const bool is_free = safe.limit(limited) == 0.0;
        const long looked_here = stages.calls("collision/look_again");
        EXPECT_EQ(safe_there.look_at_all(wanted.there()).empty(), is_free) << trial;
        const long looked_there = stages.calls("collision/look_again") - looked_here;
        EXPECT_LE(looked_there, looked_here) << trial;
        looked += int(looked_there);
        EXPECT_EQ(safe_there.look_at_all(wanted.there()).empty(), is_free)
            << trial; // strays are known by now
        EXPECT_TRUE(safe_there.look_at_all(x.there()).empty()) << trial;
        (is_free ? alone : held)++;
    }
    EXPECT_GE(alone, 15);
    EXPECT_GE(held, 15);
    EXPECT_GE(looked, 5);
}

TEST_F(DeviceClothContactTest, GoesThroughStepsAsTheCpu)
{
    Random random(63);
    int pressing = 0, found_again = 0, held_back = 0;
    for (int trial = 0; trial < 8; ++trial) {
        ClothCase made = random_cloth_case(random);
        Sides sides(space(), made);
        for (int step = 0; step < 4; ++step) {
            const std::string what = "trial " + std::to_string(trial) + " step " + std::to_string(step);
            sides.begin_step(made);
            expect_same_pressing(pairs_of(sides.host), pairs_of(sides.there), what);
            EXPECT_TRUE(are_same_bits(pairs_of(sides.there), downloaded(sides.there.pressing_there())));
            pressing += sides.there.pressing_there().size();

            std::vector<Vec3> x = made.wanted, v(x.size(), Vec3::UnitX());
            Field x_there(space(), x), v_there(space(), v);
            x_there.become_the_devices();
            v_there.become_the_devices();
            const bool is_new = sides.host.advance(x, kLeansNowhere);
            EXPECT_EQ(sides.there.advance(x_there, kLeansNowhere), is_new) << what;
            EXPECT_LT(farthest_apart(x, x_there.values()), 1e-11) << what;
            expect_same_pressing(pairs_of(sides.host), pairs_of(sides.there), what + ", advanced");
            found_again += int(is_new);

            for (Vec3& p : x)
                p += 2e-4 * random.point();
            std::copy(x.begin(), x.end(), x_there.overwrite_on_host().begin());
            x_there.become_the_devices();
            const bool is_far = sides.host.hold_back(x, v, kDt, kLeansNowhere);
            EXPECT_EQ(sides.there.hold_back(x_there, v_there, kDt, kLeansNowhere), is_far) << what;
            EXPECT_LT(farthest_apart(x, x_there.values()), 1e-11) << what;
            EXPECT_LT(farthest_apart(v, v_there.values()), 1e-11 / kDt) << what;
            held_back += int(v != std::vector<Vec3>(v.size(), Vec3::UnitX()));

            std::copy(x.begin(), x.end(), x_there.overwrite_on_host().begin());
            sides.host.end_step(x);
            sides.there.end_step(x_there);
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
    EXPECT_GT(held_back, 4);
}

TEST_F(DeviceClothContactTest, CopiesNothingToTheHostWhereNothingIsBroughtBack)
{
    Random random(64);
    ClothCase made = random_cloth_case(random);
    for (size_t v = 0; v < made.x.size(); ++v) // all fly along, one strays
        made.wanted[v] = made.expected[v] = made.x[v] + Vec3(0.1, -0.2, 0.0);
    made.wanted[5].x() -= 0.001;
    Sides sides(space(), made);
    sides.begin_step(made);
    Field x(space(), made.wanted), v(space(), made.wanted);
    x.become_the_devices();
    v.become_the_devices();
    const auto leaning = []() -> std::vector<unsigned char> {
        ADD_FAILURE() << "who leans matters to nobody";
        return {};
    };
    Stages stages;
    const Stages::Activate activate(stages);
    EXPECT_FALSE(sides.there.advance(x, leaning));
    EXPECT_FALSE(sides.there.hold_back(x, v, kDt, leaning));
    sides.there.end_step(x);
    EXPECT_FALSE(x.is_on_host());
    EXPECT_FALSE(v.is_on_host());
    EXPECT_EQ(stages.calls("collision/look_again"), 1);
    EXPECT_EQ(stages.calls("collision/safe_step_to_host"), 0);
    EXPECT_EQ(x.values(), made.wanted);
}

TEST_F(DeviceClothContactTest, HasTheSameBitsEveryTime)
{
    Random random(65);
    const ClothCase made = random_cloth_case(random);
    Sides first(space(), made), second(space(), made);
    first.begin_step(made);
    second.begin_step(made);
    EXPECT_GT(first.there.pressing_there().size(), 10);
    EXPECT_TRUE(are_same_bits(pairs_of(first.there), pairs_of(second.there)));
}

TEST_F(DeviceClothContactTest, ForgetsClothThatWasPutElsewhere)
{
    Random random(66);
    const ClothCase made = random_cloth_case(random);
    Sides sides(space(), made), fresh(space(), made);
    sides.begin_step(made);
    Field x(space(), made.wanted);
    sides.there.end_step(x);
    sides.there.forget();
    sides.begin_step(made);
    fresh.begin_step(made);
    EXPECT_TRUE(are_same_bits(pairs_of(sides.there), pairs_of(fresh.there)));
}

} // namespace
} // namespace toile::test
