#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "research/benchmarks/contact/table.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::research::contact_stress {
namespace {

bool go_on(int) { return true; }

StressCase small_case(Target target)
{
    StressCase trial;
    trial.name = "stress small";
    trial.target = target;
    trial.layers = 3;
    trial.side = 0.05;
    trial.duration = 0.08;
    return trial;
}

StressRun run_small(const StressCase& trial, unsigned seed, int threads)
{
    return run(trial, seed, stress_scene(trial, seed, threads), go_on);
}

ScalingCase small_pile(int vertices, int layers, Series series)
{
    ScalingCase trial;
    trial.name = "scaling small";
    trial.series = series;
    trial.vertices = vertices;
    trial.layers = layers;
    trial.warm_up = 4;
    trial.steps = 6;
    return trial;
}

/// Two small sheets that fall onto a ball.
scenes::Scene small_scene()
{
    return scenes::parse_scene(R"({ "toile": 1, "name": "Ball", "frames": 9,
        "avatars": [ { "name": "ball", "sphere": { "radius": 0.1 } } ],
        "cloths": [ { "name": "lower", "rectangle": { "size": [0.2, 0.2], "resolution": 0.02 },
                      "translate": [0, 0.103, 0] },
                    { "name": "upper", "rectangle": { "size": [0.2, 0.2], "resolution": 0.02 },
                      "translate": [0.004, 0.105, 0.003] } ] })",
                               "small.json");
}

TEST(PowerFit, FindsTheExponentOfAPower)
{
    std::vector<double> x, y;
    for (const double at : {1.0, 3.0, 10.0, 70.0}) {
        x.push_back(at);
        y.push_back(2.5 * std::pow(at, 1.4));
    }
    const PowerFit exact = fit_power(x, y);
    EXPECT_NEAR(exact.exponent, 1.4, 1e-12);
    EXPECT_NEAR(exact.factor, 2.5, 1e-12);
    EXPECT_NEAR(exact.worst, 1.0, 1e-12);
    EXPECT_EQ(exact.points, 4);
}

TEST(PowerFit, ReportsTheResidual)
{
    // Logarithms 0, 1, 0 over 0, 1, 2 (times log 8): a level at a third of log 8.
    const PowerFit fit = fit_power({1.0, 8.0, 64.0}, {1.0, 8.0, 1.0});
    EXPECT_NEAR(fit.exponent, 0.0, 1e-12);
    EXPECT_NEAR(fit.factor, 2.0, 1e-12);
    EXPECT_NEAR(fit.worst, 4.0, 1e-12);
}

TEST(PowerFit, SkipsZerosAndRefusesNonFinitePoints)
{
    const PowerFit fit = fit_power({0.0, 1.0, 2.0, 4.0}, {5.0, 1.0, 0.0, 4.0});
    EXPECT_EQ(fit.points, 2);
    EXPECT_NEAR(fit.exponent, 1.0, 1e-12);
    EXPECT_EQ(fit_power({2.0, 2.0}, {1.0, 3.0}).points, 0) << "one size has no slope";
    EXPECT_EQ(fit_power({}, {}).points, 0);

    EXPECT_THROW((void)fit_power({1.0, 2.0}, {1.0}), InvalidInput);
    EXPECT_THROW((void)fit_power({1.0, 2.0}, {1.0, std::numeric_limits<double>::quiet_NaN()}), InvalidInput);
}

TEST(ContactParts, AddUpToTheStep)
{
    EXPECT_EQ(part_of("collision/search_again"), Part::ClothPairs);
    EXPECT_EQ(part_of("collision/vertex_face"), Part::AvatarPairs);
    EXPECT_EQ(part_of("collision/max_safe_step"), Part::TrajectoryLimiter);
    EXPECT_EQ(part_of("linear/solve"), Part::Solve);
    EXPECT_EQ(part_of("linear/factor"), Part::Factor);
    EXPECT_EQ(part_of("garment/membrane"), Part::Minimise);
    EXPECT_EQ(part_of("no stage known"), Part::Rest);

    scenes::World world(small_scene());
    const PartSeconds start = seconds_by_part(world.stages());
    for (int frame = 0; frame < 8; ++frame)
        (void)world.advance_frame();
    const PartSeconds parts = difference(seconds_by_part(world.stages()), start);
    EXPECT_NEAR(step_seconds(parts) + seconds_of(parts, Part::Factor), world.stages().seconds("scenes/step"),
                1e-6);
    for (const Part part : {Part::ClothPairs, Part::AvatarPairs, Part::TrajectoryLimiter, Part::Minimise})
        EXPECT_GT(seconds_of(parts, part), 0.0) << name_of(part);
}

TEST(ContactStress, HasNoCrossingsOfClothWithClothAndBalls)
{
    for (const Target target : {Target::PinnedSheet, Target::Stack, Target::Ball}) {
        const StressCase trial = small_case(target);
        SCOPED_TRACE(int(target));
        const StressRun result = run_small(trial, 1, 0);
        EXPECT_EQ(result.vertices, trial.vertices());
        EXPECT_EQ(result.steps, trial.steps());
        EXPECT_GT(result.contacts, 0.5) << "they never met";
        EXPECT_GT(result.iterations, 1.0);
        EXPECT_GT(result.ms_per_step, 0.0);
        EXPECT_TRUE(result.is_finite);
        EXPECT_EQ(result.crossings, 0);
        EXPECT_GT(result.energy_ratio, 0.1);
        EXPECT_LE(result.end_energy, result.energy_ratio);
        EXPECT_EQ(result.holds, result.energy_ratio <= 1.0 + kEnergyGain);
    }
}

TEST(ContactStress, DetectsCrossingsWithoutClothContact)
{
    const StressCase trial = small_case(Target::Ball);
    scenes::Scene scene = stress_scene(trial, 1, 0);
    scene.contact.self = false;
    const StressRun result = run(trial, 1, scene, go_on);
    EXPECT_GT(result.crossings, 0);
    EXPECT_GT(result.first_crossing, 1);
    EXPECT_FALSE(result.holds);
}

TEST(ContactStress, IsReproducibleForEverySeedAndThreadCount)
{
    const StressCase trial = small_case(Target::Stack);
    const StressRun one = run_small(trial, 3, 1), two = run_small(trial, 3, 2),
                    other = run_small(trial, 4, 1);
    EXPECT_EQ(one.energy_ratio, two.energy_ratio);
    EXPECT_EQ(one.max_strain, two.max_strain);
    EXPECT_EQ(one.contacts, two.contacts);
    EXPECT_NE(one.max_strain, other.max_strain);
}

TEST(ContactStress, ReportsTheWorstOfItsSeeds)
{
    StressRun good, bad;
    good.seed = 1;
    good.holds = true;
    good.contacts = 10.0;
    good.max_strain = 0.3;
    bad.seed = 2;
    bad.crossings = 7;
    bad.first_crossing = 5;
    bad.contacts = 20.0;
    const StressResult result = summarise(small_case(Target::Ball), {good, bad});
    EXPECT_FALSE(result.worst.holds);
    EXPECT_EQ(result.worst.seed, 2u);
    EXPECT_EQ(result.worst.crossings, 7);
    EXPECT_EQ(result.worst.first_crossing, 5);
    EXPECT_EQ(result.worst.contacts, 15.0);
    EXPECT_EQ(result.worst.max_strain, 0.3);
}

TEST(ContactCases, HaveUniqueNamesThatBeginWithTheirGroup)
{
    for (const Size size : {Size::Full, Size::Quick}) {
        std::set<std::string> names;
        for (const StressCase& trial : stress_cases(size)) {
            EXPECT_TRUE(names.insert(trial.name).second) << trial.name;
            EXPECT_EQ(trial.name.rfind("stress ", 0), 0u) << trial.name;
        }
        for (const ScalingCase& trial : scaling_cases(size)) {
            EXPECT_TRUE(names.insert(trial.name).second) << trial.name;
            EXPECT_EQ(trial.name.rfind("scaling ", 0), 0u) << trial.name;
        }
        EXPECT_GT(names.size(), 25u);
    }
}

TEST(ContactScaling, MeasuresPilesInContactAndFitsThem)
{
    std::vector<ScalingResult> results;
    for (const ScalingCase& trial :
         {small_pile(150, 3, Series::Vertices), small_pile(600, 3, Series::Vertices)}) {
        results.push_back(run(trial, 0, go_on));
        EXPECT_NEAR(results.back().vertices, trial.vertices, 0.1 * trial.vertices);
        EXPECT_GT(results.back().contacts, 5.0);
        EXPECT_GT(seconds_of(results.back().parts, Part::ClothPairs), 0.0);
        EXPECT_EQ(seconds_of(results.back().parts, Part::AvatarPairs), 0.0) << "there is none";
    }
    // Four times the vertices in the same configuration: about four times the contacts.
    const std::vector<ScalingFit> fits = fit(results);
    const auto contacts =
        std::find_if(fits.begin(), fits.end(), [](const ScalingFit& of) { return of.what == "contacts"; });
    ASSERT_NE(contacts, fits.end());
    EXPECT_EQ(contacts->by_vertices.points, 2);
    EXPECT_NEAR(contacts->by_vertices.exponent, 1.0, 0.75);
    EXPECT_TRUE(fit({results[0]}).empty()) << "one size has no exponent";
}

TEST(ContactDressed, RunsWithAndWithoutClothContact)
{
    int frames = 0;
    const DressedResult result = run(small_scene(), 0, [&](int frame) { return frame == ++frames; });
    EXPECT_EQ(result.name, "small");
    EXPECT_EQ(result.frames, 8);
    EXPECT_EQ(frames, 8);
    EXPECT_EQ(result.vertices, 242);
    EXPECT_GT(result.contacts, 0.0);
    EXPECT_GT(seconds_of(result.with, Part::ClothPairs), 0.0);
    EXPECT_GT(result.ratio(), 0.0);
    EXPECT_GT(result.detection_fraction(), 0.0);
    EXPECT_LT(result.detection_fraction(), 1.0);
}

TEST(ContactTable, HasARowPerCaseSeedAndScene)
{
    Results results;
    EXPECT_EQ(markdown_tables(results), "");
    StressRun crossed;
    crossed.seed = 2;
    crossed.crossings = 3;
    results.stress = {summarise(small_case(Target::Ball), {StressRun{}, crossed})};
    DressedResult slow;
    slow.name = "slow";
    slow.with[size_t(Part::AvatarPairs)] = 0.006;
    slow.with[size_t(Part::Minimise)] = 0.004;
    slow.without[size_t(Part::Minimise)] = 0.004;
    results.dressed = {slow};

    const std::string stress = csv_of_stress(results.stress);
    EXPECT_EQ(std::count(stress.begin(), stress.end(), '\n'), 3);
    EXPECT_NE(stress.find("\nstress small,2,0,0,3,"), std::string::npos) << stress;
    const std::string tables = markdown_tables(results);
    EXPECT_NE(tables.find("OVER HALF"), std::string::npos) << "six of ten milliseconds look for pairs";
    EXPECT_EQ(tables.find("Scaling"), std::string::npos);
    for (const std::string& table : {stress, csv_of_scaling({ScalingResult{}}), csv_of_dressed({slow})}) {
        const size_t header = table.find('\n'), row = table.find('\n', header + 1);
        EXPECT_EQ(std::count(table.begin(), table.begin() + long(header), ','),
                  std::count(table.begin() + long(header), table.begin() + long(row), ','))
            << table;
    }
}

} // namespace
} // namespace toile::research::contact_stress
