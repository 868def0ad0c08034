#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/mesh/obj.h"
#include "tests/apps/program.h"

/// Memory of runs, as their reports state it.
namespace toile::test {

namespace {

constexpr double kMega = 1e6;

class Memory : public FileTest {
protected:
    /// Peak of a run [bytes].
    double peak_of(const std::string& scene, const std::vector<std::string>& more = {}) const
    {
        temporary_.write("s.json", scene);
        std::vector<std::string> arguments{"simulate", "s.json",     "-o",        "out", "--report",
                                           "r.json",   "--no-check", "--threads", "2",   "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Finished run = run_toile(arguments, folder_);
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        return nlohmann::json::parse(bytes_of(file("r.json")))["peak_memory_bytes"];
    }
};

/// A sheet that a turning box drags and folds: contact with the box and with itself in every frame.
const char* const kDragged = R"({"toile": 1, "frames": 800, "fps": 30,
    "solver": {"substeps": 1, "sleep": {"enabled": false}},
    "avatars": [{"name": "box", "box": {"size": [0.3, 0.1, 0.2]}, "keyframes": [{"time": 0}, {"time": 27,
        "rotate_deg": [0, 2700, 0]}]}, {"name": "floor", "plane": {}, "translate": [0, -0.06, 0]}],
    "cloths": [{"name": "sheet", "rectangle": {"size": [0.5, 0.5], "resolution": 0.05},
        "translate": [0, 0.053, 0]}]})";

TEST_F(Memory, DoesNotGrowWithTheFrames)
{
    const double early = peak_of(kDragged, {"--frames", "100"}), late = peak_of(kDragged);
    EXPECT_LT(late - early, 3.0 * kMega) << early / kMega << " MB after 100 frames";
    RecordProperty("growth_kB", int((late - early) / 1e3));
}

/// Nor does that of the program count that starts the run.
TEST_F(Memory, OfASkirtOf2300VerticesIsBounded)
{
    const std::vector<char> of_this_process(300'000'000, 1);
    const double peak =
        peak_of(R"({"toile": 1, "frames": 6, "avatars": [{"name": "mannequin", "mannequin": {},
        "clip": "walk"}], "cloths": [{"name": "skirt", "skirt": {"waist_radius": 0.135, "hem_radius": 0.3,
        "length": 0.55, "resolution": 0.0185}, "translate": [0, 1.08, 0], "fabric": "denim"}], "attachments": [
        {"cloth": "skirt", "select": {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}},
        "to": "mannequin"}]})");
    EXPECT_LT(peak, 200.0 * kMega);
    RecordProperty("peak_MB", int(peak / kMega));
}

/// A body in the form of a spindle, from the floor to 1.8 m.
ObjMesh spindle()
{
    constexpr int kRings = 15, kSides = 24;
    ObjMesh mesh;
    for (int i = 0; i < kRings; ++i)
        for (int k = 0; k < kSides; ++k) {
            const double t = std::numbers::pi * (i + 1) / (kRings + 1),
                         p = 2.0 * std::numbers::pi * k / kSides;
            mesh.positions.emplace_back(0.13 * std::sin(t) * std::cos(p), 0.9 + 0.9 * std::cos(t),
                                        0.13 * std::sin(t) * std::sin(p));
        }
    const int top = kRings * kSides, bottom = top + 1;
    mesh.positions.emplace_back(0.0, 1.8, 0.0);
    mesh.positions.emplace_back(0.0, 0.0, 0.0);
    for (int k = 0; k < kSides; ++k) {
        const int next = (k + 1) % kSides, last = (kRings - 1) * kSides;
        mesh.polygons.push_back({top, next, k});
        mesh.polygons.push_back({bottom, last + k, last + next});
        for (int i = 0; i + 1 < kRings; ++i)
            mesh.polygons.push_back(
                {i * kSides + k, i * kSides + next, (i + 1) * kSides + next, (i + 1) * kSides + k});
    }
    return mesh;
}

/// The skirt is pulled through 5 m within a step, as by a clip that is looped without accumulate_root.
TEST_F(Memory, OfAJumpIsBounded)
{
    write_obj(file("body.obj"), spindle());
    const double peak = peak_of(R"({"toile": 1, "frames": 6, "avatars": [{"name": "body", "file": "body.obj",
        "keyframes": [{"time": 0.13}, {"time": 0.14, "translate": [0, 0, 5]}]}], "cloths": [{"name": "skirt",
        "skirt": {"waist_radius": 0.135, "hem_radius": 0.3, "length": 0.55, "resolution": 0.04},
        "translate": [0, 1.08, 0], "fabric": "denim"}], "attachments": [{"cloth": "skirt", "select":
        {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}}, "to": "body"}]})");
    EXPECT_LT(peak, 200.0 * kMega);
    RecordProperty("peak_MB", int(peak / kMega));
}

} // namespace
} // namespace toile::test
