#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

TEST_F(Memory, OfASkirtOf1700VerticesIsBounded)
{
    const double peak =
        peak_of(R"({"toile": 1, "frames": 6, "avatars": [{"name": "mannequin", "mannequin": {},
        "clip": "walk"}], "cloths": [{"name": "skirt", "skirt": {"waist_radius": 0.135, "hem_radius": 0.3,
        "length": 0.55, "resolution": 0.0185}, "translate": [0, 1.08, 0], "fabric": "denim"}], "attachments": [
        {"cloth": "skirt", "select": {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}},
        "to": "mannequin"}]})");
    EXPECT_LT(peak, 200.0 * kMega);
    RecordProperty("peak_MB", int(peak / kMega));
}

} // namespace
} // namespace toile::test
