#include "scenes/world/backend.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/compute/cuda/runtime/device.h"
#include "scenes/format/read_scene.h"
#include "scenes/method/solver_choice.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

Scene scene_with(const std::string& keys)
{
    return parse_scene(
        R"({"toile": 1, "frames": 3, )" + keys +
            R"("cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.05}}]})",
        "test.json");
}

TEST(Backend, NamesFeaturesThatNeedTheCpu)
{
    EXPECT_EQ(why_not_on_gpu(scene_with("")), "");
    EXPECT_EQ(why_not_on_gpu(scene_with(R"("solver": {"method": "quadrature"}, )")), "");
    EXPECT_EQ(why_not_on_gpu(scene_with(R"("solver": {"method": "a-jacobi"}, )")), "");
    EXPECT_EQ(why_not_on_gpu(scene_with(R"("solver": {"method": "multigrid"}, )")),
              R"(solver.method "multigrid" runs on the CPU only)");
    EXPECT_EQ(why_not_on_gpu(scene_with(R"("solver": {"outer": "anderson"}, )")),
              R"(solver.outer "anderson" runs on the CPU only)");
    EXPECT_EQ(why_not_on_gpu(scene_with(R"("solver": {"contact_preconditioner": "exact"}, )")),
              R"(solver.contact_preconditioner "exact" runs on the CPU only)");
    EXPECT_EQ(why_not_on_gpu(
                  scene_with(R"("solids": [{"name": "ball", "sphere": {"radius": 0.1}, "density": 500}], )")),
              "solids run on the CPU only");

    Scene cloth = scene_with("");
    cloth.cloths[0].sewing = scene::Sewing{};
    EXPECT_EQ(why_not_on_gpu(cloth), "threads that sew run on the CPU only");
    cloth.cloths[0].sewing.reset();
    cloth.cloths[0].elastics.resize(1);
    EXPECT_EQ(why_not_on_gpu(cloth), "elastics run on the CPU only");
    cloth.cloths[0].elastics.clear();
    cloth.cloths[0].folds.resize(1);
    EXPECT_EQ(why_not_on_gpu(cloth), "folds of cloth run on the CPU only");
}

TEST(Backend, RefusesASceneThatNeedsTheCpu)
{
    WorldOptions options;
    options.backend = Backend::Cuda;
    try {
        const World world(scene_with(R"("solver": {"outer": "anderson"}, )"), options);
        FAIL() << "took it";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "test.json: solver.outer \"anderson\" runs on the CPU only; choose the backend cpu "
                     "or auto, or change the scene");
    }
}

TEST(Backend, FallsBackToTheCpuWithoutAWorkingGpu)
{
    std::string warning;
    WorldOptions options;
    options.backend = Backend::Auto;
    options.warn = [&](const std::string& text) { warning += text; };
    World world(scene_with(R"("solver": {"outer": "anderson"}, )"), options);
    EXPECT_EQ(warning, R"(the backend is cpu: solver.outer "anderson" runs on the CPU only)");
    EXPECT_EQ(world.device(), nullptr);
    EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
}

TEST(Backend, SaysWhichInternalFrictionHasNoEffect)
{
    const auto scene = [](const std::string& solver) {
        return scene_with(solver + R"("fabrics": {"rubber": {"bend_friction": 5, "shear_damping": 0}}, )");
    };
    const std::vector<std::string> none,
        preview{"test.json: fabrics.rubber.bend_friction has no effect: internal friction acts with Newton's "
                "method (solver.outer)"};
    EXPECT_EQ(solver_warnings_of(scene("")), none);
    EXPECT_EQ(solver_warnings_of(scene(R"("solver": {"quality": "preview"}, )")), preview);
    EXPECT_EQ(solver_warnings_of(scene_with(R"("solver": {"outer": "lbfgs"}, )")), none);
}

TEST(Backend, SaysThatEqualStepsHaveNoChosenError)
{
    const auto warnings = [](const std::string& solver) {
        return solver_warnings_of(scene_with("\"solver\": {\"step_error\": 1e-4" + solver + "}, "));
    };
    EXPECT_TRUE(warnings("").empty());
    const std::vector<std::string> two{"test.json: solver.step_error has no effect: all steps are equal, 2 a "
                                       "sample; see solver.substeps for when "
                                       "what moves chooses them"};
    EXPECT_EQ(warnings(R"(, "substeps": 2)"), two);
    EXPECT_EQ(warnings(R"(, "quality": "preview")").size(), 1u);
    EXPECT_EQ(warnings(R"(, "method": "direct")").size(), 1u);
}

TEST(Backend, ReportsWhyThereIsNoGpu)
{
    const std::string why = why_no_cuda_device();
    if (why.empty())
        GTEST_SKIP() << "this machine has a CUDA device";
    WorldOptions options;
    options.backend = Backend::Cuda;
    try {
        const World world(scene_with(""), options);
        FAIL() << "took it";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace toile::test
