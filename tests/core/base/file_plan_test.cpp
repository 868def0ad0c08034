#include "core/base/file_plan.h"
#include "tests/support/refusal.h"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A scene of the user's and every way to name it.
class FilePlanTest : public FileTest {
protected:
    FilePlanTest()
    {
        temporary_.write("scene.json", "precious");
        std::filesystem::create_directory(file("sub"));
        std::filesystem::create_symlink("scene.json", file("link.json"));
        std::filesystem::create_hard_link(file("scene.json"), file("twin.json"));
        std::filesystem::create_directory_symlink("sub", file("door"));
    }
};

TEST_F(FilePlanTest, RefusesEveryNameOfAnInput)
{
    for (const char* name : {"scene.json", "./scene.json", "sub/../scene.json", "door/../scene.json",
                             "link.json", "twin.json", "sub//.././scene.json"}) {
        FilePlan plan;
        plan.add_input(file("scene.json"), "the scene");
        EXPECT_THAT(refusal([&] { plan.add_output(file(name), "the report"); }),
                    AllOf(HasSubstr(name), HasSubstr("the report would replace"), HasSubstr("the scene")))
            << name;
    }
}

TEST_F(FilePlanTest, RefusesTwoNamesOfAnOutputThatDoesNotExist)
{
    FilePlan plan;
    plan.add_output(file("sub/new.pc2"), "the cache");
    EXPECT_THAT(refusal([&] { plan.add_output(file("door/new.pc2"), "the mesh"); }),
                AllOf(HasSubstr("the mesh is in the way of"), HasSubstr("sub/new.pc2, the cache")));
    EXPECT_EQ(refusal([&] { plan.add_output(file("sub/other.pc2"), "the mesh"); }), "");
}

TEST_F(FilePlanTest, RefusesAFileWhereAnotherNeedsAFolder)
{
    FilePlan plan;
    plan.add_output(file("new/deep/a.pc2"), "the cache");
    EXPECT_THAT(refusal([&] { plan.add_output(file("new"), "the report"); }),
                HasSubstr("the report is in the way of"));
    EXPECT_THAT(refusal([&] { plan.add_output(file("new/deep/a.pc2/b"), "the report"); }),
                HasSubstr("the report is in the way of"));
}

TEST_F(FilePlanTest, AcceptsRepeatedInputsAndStreams)
{
    FilePlan plan;
    plan.add_input(file("scene.json"), "the scene");
    plan.add_input(file("link.json"), "a cloth");
    plan.add_output("/dev/null", "the report");
    EXPECT_EQ(refusal([&] { plan.add_output("/dev/null", "the certificate"); }), "");
}

} // namespace
} // namespace toile::test
