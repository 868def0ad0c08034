#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

/// toile measure: what it prints and refuses.
namespace toile::test {

namespace {

class Measure : public FileTest {
protected:
    Finished measure(const std::vector<std::string>& arguments) const
    {
        std::vector<std::string> words{"measure"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        return run_toile(words, temporary_.path());
    }

    std::string data(const std::string& name) const
    {
        return (std::filesystem::path(TOILE_DATA_DIR) / name).string();
    }
};

bool data_is_missing() { return !std::filesystem::is_directory(TOILE_DATA_DIR); }

} // namespace

TEST_F(Measure, PrintsATableInCentimetres)
{
    const Finished finished = measure({});
    EXPECT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_EQ(finished.output.find("height                  174.9"), 0u) << finished.output;
    EXPECT_NE(finished.output.find("arm_pose_angle"), std::string::npos);
    EXPECT_NE(finished.output.find(" deg "), std::string::npos);
    EXPECT_NE(finished.output.find("bum_points: not measured"), std::string::npos);
}

TEST_F(Measure, PrintsJsonInMetres)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const Finished finished = measure({data("bodies/gc_mean_all.obj"), "--json"});
    ASSERT_EQ(finished.exit_code, 0) << finished.errors;
    const nlohmann::json json = nlohmann::json::parse(finished.output);
    EXPECT_NEAR(json["lengths_m"]["height"].get<double>(), 1.7199, 0.003);
    EXPECT_NEAR(json["lengths_m"]["waist"].get<double>(), 0.8434, 0.01);
    EXPECT_NEAR(json["angles_deg"]["arm_pose_angle"].get<double>(), 45.5, 1.0);
    EXPECT_EQ(json["not_measured"], nlohmann::json({"bum_points"}));
    EXPECT_EQ(json["lengths_m"].size() + json["angles_deg"].size() + 1, 26u) << "keys of gc_mean_all.yaml";

    // Its landmarks can be edited and given back.
    std::ofstream(temporary_.path() / "landmarks.json") << json["landmarks"].dump();
    const Finished again =
        measure({data("bodies/gc_mean_all.obj"), "--json", "--landmarks", "landmarks.json"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_EQ(nlohmann::json::parse(again.output)["landmarks"], json["landmarks"]);
}

TEST_F(Measure, ReadsOtherUnits)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    const Finished finished = measure({data("bodies/gc_mean_all.obj"), "--unit", "cm"});
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_EQ(finished.error_lines(), 1);
    EXPECT_NE(finished.errors.find("stands 0.0172 m tall; give the unit of its file"), std::string::npos)
        << finished.errors;
}

TEST_F(Measure, RefusesWhatIsNoStandingBody)
{
    if (data_is_missing())
        GTEST_SKIP() << "no " << TOILE_DATA_DIR;
    for (const auto& [body, part] :
         {std::pair("colliders/spot_triangulated.obj", "two legs can't be found"),
          std::pair("bodies/nobody.obj", "no such file"),
          std::pair("cloth/cipc_square57.obj", "a body can't be found: it has no height")}) {
        const Finished finished = measure({data(body)});
        EXPECT_EQ(finished.exit_code, 2) << body;
        EXPECT_EQ(finished.error_lines(), 1) << finished.errors;
        EXPECT_NE(finished.errors.find(part), std::string::npos) << finished.errors;
    }
    temporary_.write("landmarks.json", R"({"left_rist": [0, 1, 0]})");
    const Finished finished = measure({"--landmarks", "landmarks.json"});
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_NE(finished.errors.find("did you mean 'left_wrist'?"), std::string::npos) << finished.errors;
}

} // namespace toile::test
