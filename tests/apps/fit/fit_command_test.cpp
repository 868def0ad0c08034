#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/apps/fit/tubes.h"
#include "tests/apps/program.h"

/// toile fit: any frame of a cache.
namespace toile::test {

namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

constexpr double kBody = 0.15, kSkirt = 0.2; ///< [m] radii

class FitCommand : public FileTest {
protected:
    void SetUp() override
    {
        write_obj(file("column.obj"), tube(kBody));
        write_obj(file("skirt.obj"), tube(kSkirt));
        write_obj(file("now.obj"), tube(1.03 * kSkirt));
        temporary_.write("scene.json", scene(R"({"name": "column", "file": "column.obj"})"));
    }

    static std::string scene(const std::string& avatar)
    {
        return R"({"toile": 1, "frames": 1, "avatars": [)" + avatar + R"(],
                   "cloths": [{"name": "skirt", "file": "skirt.obj", "fabric": "cotton"}]})";
    }

    Finished fit(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "fit");
        return run_toile(arguments, folder_);
    }

    void expect_refusal(const std::vector<std::string>& arguments, const std::string& says) const
    {
        const auto before = temporary_.snapshot();
        const Finished finished = fit(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.errors;
        EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
        EXPECT_THAT(finished.errors, HasSubstr(says));
        EXPECT_EQ(temporary_.snapshot(), before);
    }
};

/// A tube that is 3 % wider than at rest, about a column: cotton has 261.1 N/m in both directions.
TEST_F(FitCommand, MeasuresTheClothOfACache)
{
    const Finished finished = fit({"now.obj", "--scene", "scene.json", "-o", "out"});
    ASSERT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_THAT(finished.output, HasSubstr("out/fit.json"));
    std::istringstream table(bytes_of(file("out/skirt_fit.csv")));
    std::string line;
    std::getline(table, line);
    int rows = 0;
    for (double vertex, tension, strain, gap; std::getline(table, line); ++rows) {
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &vertex, &tension, &strain, &gap), 4);
        EXPECT_NEAR(tension, 261.1 * 0.03, 1e-4);
        EXPECT_NEAR(strain, 0.03, 1e-6);
        EXPECT_NEAR(gap, 1.03 * kSkirt - kBody, 1e-6);
    }
    EXPECT_EQ(rows, tube(kSkirt).vertex_count());
    EXPECT_THAT(Json::parse(bytes_of(file("out/fit.json")))["garments"][0]["not_measured"].get<std::string>(),
                HasSubstr("two legs can't be found"));
}

TEST_F(FitCommand, ReadsCachesInAnotherUnitAndAxis)
{
    TriangleMesh other = tube(1.03 * kSkirt);
    for (Vec3& x : other.positions)
        x = 100.0 * Vec3(x.x(), -x.z(), x.y());
    write_obj(file("other.obj"), other);
    ASSERT_EQ(fit({"now.obj", "--scene", "scene.json", "-o", "a"}).exit_code, 0);
    const Finished told =
        fit({"other.obj", "--scene", "scene.json", "-o", "b", "--from-unit", "cm", "--from-up", "z"});
    ASSERT_EQ(told.exit_code, 0) << told.errors;
    const auto mean_gap = [&](const std::string& folder) {
        std::istringstream table(bytes_of(file(folder + "/skirt_fit.csv")));
        std::string line;
        std::getline(table, line);
        double sum = 0.0;
        int rows = 0;
        for (double vertex, tension, strain, gap; std::getline(table, line); sum += gap, ++rows)
            EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &vertex, &tension, &strain, &gap), 4);
        return sum / rows;
    };
    EXPECT_NEAR(mean_gap("b"), 1.03 * kSkirt - kBody, 1e-6);
    EXPECT_NEAR(mean_gap("a"), mean_gap("b"), 1e-6);
}

TEST_F(FitCommand, RefusesWhatDoesNotFit)
{
    expect_refusal({"now.obj", "--scene", "scene.json", "--frame", "1"},
                   "--frame 1: now.obj has frames 0 to 0, or -1 for the last");
    write_obj(file("other.obj"), together(tube(0.2), tube(0.3)));
    expect_refusal({"other.obj", "--scene", "scene.json"}, "other.obj");
    expect_refusal({"now.obj", "--scene", "scene.json", "--cloth", "skrit"}, "did you mean \"skirt\"?");
    temporary_.write("plane.json", scene(R"({"name": "floor", "plane": {}})"));
    expect_refusal({"now.obj", "--scene", "plane.json"}, "plane.json: has no avatar with a skin");
    write_obj(file("fit/skirt_gap.obj"), tube(kSkirt));
    expect_refusal({"fit/skirt_gap.obj", "--scene", "scene.json"}, "fit/skirt_gap.obj");
}

} // namespace
} // namespace toile::test
