#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

/// Bodies from caches in all commands.
namespace toile::test {

namespace {

using testing::HasSubstr;

class CachedBodyCommands : public FileTest {
protected:
    /// A ball of 0.2 m that moves by 0.25 m along X in half a second, and a sheet that hangs 0.1 m before it.
    CachedBodyCommands()
    {
        std::filesystem::copy(std::filesystem::path(TOILE_SOURCE_DIR) /
                                  "tests/scenes/caches/samples/slide.abc",
                              file("slide.abc"));
        temporary_.write("moves.json", scene(""));
        temporary_.write("stands.json", scene(R"(, "speed": 0)"));
    }

    static std::string scene(const std::string& keys)
    {
        return R"({"toile": 1, "frames": 16, "fps": 32, "avatars": [{"name": "ball", "file": "slide.abc")" +
               keys +
               R"(}], "cloths": [{"name": "sheet", "rectangle": {"size": [0.5, 0.5], "resolution": 0.04},
        "rotate_deg": [0, 0, 90], "translate": [0.3, 0, 0]}], "attachments": [{"cloth": "sheet",
        "select": {"box": {"lower": [0, 0.24, -1], "upper": [1, 1, 1]}}}]})";
    }

    Finished run(const std::vector<std::string>& arguments) const { return run_toile(arguments, folder_); }

    nlohmann::json json(const std::string& name) const
    {
        std::ifstream stream(file(name));
        return nlohmann::json::parse(stream);
    }
};

TEST_F(CachedBodyCommands, PushesClothThatIsCertifiedAndDrawn)
{
    const Finished simulated = run({"simulate", "moves.json", "-o", "out", "--quiet"});
    EXPECT_EQ(simulated.exit_code, 0) << simulated.errors;
    const Finished checked = run({"check", "out", "--scene", "moves.json", "-o", "checked.json", "--quiet"});
    EXPECT_EQ(checked.exit_code, 0) << checked.output << checked.errors;
    const Finished drawn = run({"render", "out/sheet.pc2", "--scene", "moves.json", "-o", "last.png",
                                "--width", "64", "--height", "48", "--samples", "1", "--quiet"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
    EXPECT_THAT(run({"info", "moves.json"}).output, HasSubstr("avatar: ball, cache slide.abc"));
}

TEST_F(CachedBodyCommands, CertificatesFollowTheBody)
{
    ASSERT_EQ(run({"simulate", "stands.json", "-o", "out", "--quiet"}).exit_code, 0);
    EXPECT_EQ(run({"check", "out", "--scene", "stands.json", "--quiet"}).exit_code, 0);
    const Finished checked = run({"check", "out", "--scene", "moves.json", "-o", "checked.json", "--quiet"});
    EXPECT_EQ(checked.exit_code, 1);
    EXPECT_GT(json("checked.json")["cloth_avatar_crossings"].get<int>(), 0) << json("checked.json").dump(1);
}

TEST_F(CachedBodyCommands, KeepTheCacheThatTheyRead)
{
    const std::string before = bytes_of(file("slide.abc"));
    std::string text = scene("");
    text.insert(text.size() - 1, R"(, "export": [{"file": "slide.abc"}])");
    temporary_.write("over.json", text);
    const Finished refused = run({"simulate", "over.json", "-o", ".", "--quiet"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr("slide.abc"));
    EXPECT_EQ(bytes_of(file("slide.abc")), before);
}

} // namespace

} // namespace toile::test
