#include <gtest/gtest.h>

#include <utility>

#include "core/base/error.h"
#include "garment/seam/sewing.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "scenes/world/world_crossings.h"
#include "tests/support/temporary_folder.h"

/// Cloth that is sewn along the lines of its file.
namespace toile::test {

using namespace scenes;

namespace {

constexpr int kSide = 10;     // edges along a side of 10 cm
constexpr double kGap = 0.06; // [m] between the squares
constexpr int kFramesIn1s = 30;

int vertex(int square, int i, int k) { return square * (kSide + 1) * (kSide + 1) + i * (kSide + 1) + k; }

std::string line(int a, int b) { return "l " + std::to_string(a + 1) + " " + std::to_string(b + 1) + "\n"; }

/// Two flat squares of 10 cm side by side, 6 cm apart along x, without lines.
std::string squares()
{
    std::string text;
    for (int square = 0; square < 2; ++square)
        for (int i = 0; i <= kSide; ++i)
            for (int k = 0; k <= kSide; ++k)
                text += "v " + std::to_string(square * (0.1 + kGap) + 0.01 * i) + " 0 " +
                        std::to_string(0.01 * k) + "\n";
    for (int square = 0; square < 2; ++square)
        for (int i = 0; i < kSide; ++i)
            for (int k = 0; k < kSide; ++k) {
                text += "f";
                for (const auto& [di, dk] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                    text += " " + std::to_string(vertex(square, i + di, k + dk) + 1);
                text += "\n";
            }
    return text;
}

/// One for each pair of vertices of the facing sides.
std::string seam()
{
    std::string text;
    for (int k = 0; k <= kSide; ++k)
        text += line(vertex(0, kSide, k), vertex(1, 0, k));
    return text;
}

class SewnScene : public testing::Test {
protected:
    World world_of(const std::string& obj, const std::string& keys = R"(, "sewing": {})")
    {
        warnings_.clear();
        folder_.write("cloth.obj", obj);
        WorldOptions options;
        options.warn = [this](const std::string& text) { warnings_ += text + "\n"; };
        return World(parse_scene(R"({"toile": 1, "frames": 40, "gravity": [0, 0, 0],
            "cloths": [{"name": "c", "file": "cloth.obj")" +
                                     keys + "}]}",
                                 folder_.path() / "scene.json"),
                     options);
    }

    TemporaryFolder folder_;
    std::string warnings_;
};

void advance_1s(World& world)
{
    for (int frame = 0; frame < kFramesIn1s; ++frame)
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
}

garment::SeamGaps seam_of(const World& world)
{
    std::vector<garment::Sewing::Thread> threads;
    for (int k = 0; k <= kSide; ++k)
        threads.push_back({vertex(0, kSide, k), vertex(1, 0, k)});
    return gaps_of(threads, world.cloths()[0].positions);
}

TEST_F(SewnScene, ClosesASeamOf6CmIn1s)
{
    World world = world_of(squares() + seam());
    EXPECT_EQ(warnings_, "");
    EXPECT_NEAR(seam_of(world).max, kGap, 1e-9);
    advance_1s(world);
    EXPECT_LT(seam_of(world).max, 0.002);
    EXPECT_EQ(crossing_count(world), 0);
}

TEST_F(SewnScene, LeavesLinesOutWithoutTheKey)
{
    World world = world_of(squares() + seam(), "");
    EXPECT_NE(warnings_.find("left out 11 lines between vertices; \"sewing\": {} sews along them"),
              std::string::npos)
        << warnings_;
    const std::vector<Vec3> start = world.cloths()[0].positions;
    advance_1s(world);
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((world.cloths()[0].positions[v] - start[v]).norm(), 1e-9);
}

TEST_F(SewnScene, DropsLinesToLooseVertices)
{
    World world = world_of(squares() + "v 9 9 9\n" + line(vertex(1, kSide, 0), vertex(1, kSide, kSide) + 1));
    EXPECT_TRUE(world.cloths()[0].rest.lines.empty());
    const std::vector<Vec3> start = world.cloths()[0].positions;
    advance_1s(world);
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((world.cloths()[0].positions[v] - start[v]).norm(), 1e-9);
}

TEST_F(SewnScene, CountsRepeatedLinesOnce)
{
    std::string reversed;
    for (int k = 0; k <= kSide; ++k)
        reversed += line(vertex(1, 0, k), vertex(0, kSide, k));
    World once = world_of(squares() + seam());
    World thrice = world_of(squares() + seam() + seam() + reversed);
    for (int frame = 0; frame < 5; ++frame) {
        (void)once.advance_frame();
        (void)thrice.advance_frame();
    }
    EXPECT_EQ(once.cloths()[0].positions, thrice.cloths()[0].positions);
}

TEST_F(SewnScene, RefusesLinesOutOfRange)
{
    try {
        world_of(squares() + "l 1 999\n");
        FAIL() << "not refused";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("cloth.obj:443: vertex index 999 is out of range"),
                  std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace toile::test
