#include <algorithm>
#include <csignal>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include "export/byte_order.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;
using testing::Not;

class VtkTest : public ExportTest {
protected:
    void write(const CacheLayout& layout) const
    {
        const auto writer = make_cache_writer(file("skirt.pvd"), layout);
        write_frames(*writer, 0, layout.frame_count, 7);
        writer->finish();
    }

    /// Raw array of this name behind the XML.
    static std::string array(const std::string& vtu, const std::string& name)
    {
        const size_t element = vtu.find("Name=\"" + name + "\"");
        const size_t offset = vtu.find("offset=\"", element) + 8;
        const size_t data = vtu.find("<AppendedData encoding=\"raw\">\n_") + 31;
        const size_t at = data + std::stoul(vtu.substr(offset));
        return vtu.substr(at + 8, take<std::uint64_t>(&vtu[at]));
    }

    static std::vector<Vec3> vectors(const std::string& bytes)
    {
        const std::vector<float> values = values_of<float>(bytes);
        std::vector<Vec3> all;
        for (size_t k = 0; k + 2 < values.size(); k += 3)
            all.push_back(Vec3(values[k], values[k + 1], values[k + 2]));
        return all;
    }

    static std::ptrdiff_t entries(const std::string& pvd)
    {
        std::ptrdiff_t count = 0;
        for (size_t at = pvd.find("<DataSet "); at != std::string::npos; at = pvd.find("<DataSet ", at + 1))
            ++count;
        return count;
    }
};

TEST_F(VtkTest, ListsNumberedFilesWithTheirTimes)
{
    CacheLayout layout = cache_layout(quad_mesh(), 3);
    layout.fps = 25.0;
    layout.start_frame = 1001.0;
    write(layout);
    EXPECT_EQ(bytes_of(file("skirt.pvd")),
              "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
              "<DataSet timestep=\"40.04\" part=\"0\" file=\"skirt_1001.vtu\"/>\n"
              "<DataSet timestep=\"40.08\" part=\"0\" file=\"skirt_1002.vtu\"/>\n"
              "<DataSet timestep=\"40.12\" part=\"0\" file=\"skirt_1003.vtu\"/>\n"
              "</Collection>\n</VTKFile>\n");
    EXPECT_FALSE(std::filesystem::exists(file("skirt.partial")));
}

TEST_F(VtkTest, StoresPositionsCellsAndVelocities)
{
    CacheLayout layout = cache_layout(quad_mesh(), 3);
    layout.fps = 25.0;
    write(layout);
    for (int k = 0; k < 3; ++k) {
        const std::string vtu = bytes_of(file("skirt_000" + std::to_string(k) + ".vtu"));
        EXPECT_THAT(vtu, HasSubstr("NumberOfPoints=\"7\" NumberOfCells=\"3\""));
        EXPECT_EQ(vectors(array(vtu, "Points")), frame_positions(k, 7));
        EXPECT_EQ(values_of<std::int64_t>(array(vtu, "connectivity")),
                  (std::vector<std::int64_t>{0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6}));
        EXPECT_EQ(values_of<std::int64_t>(array(vtu, "offsets")), (std::vector<std::int64_t>{4, 8, 11}));
        EXPECT_EQ(array(vtu, "types"), "\x09\x09\x05");
        for (const Vec3& v : vectors(array(vtu, "velocity")))
            EXPECT_EQ(v, Vec3(25.0, 0.0, -2500.0));
    }
}

TEST_F(VtkTest, LeavesOutVelocities)
{
    CacheLayout layout = cache_layout(quad_mesh(), 2);
    layout.velocities = false;
    write(layout);
    const std::string vtu = bytes_of(file("skirt_0001.vtu"));
    EXPECT_THAT(vtu, Not(HasSubstr("velocity")));
    EXPECT_EQ(vectors(array(vtu, "Points")), frame_positions(1, 7));
}

/// The last frame waits for its velocity.
TEST_F(VtkTest, ListsTheFramesOfAKilledRun)
{
    CacheLayout layout = cache_layout(quad_mesh(), 9);
    for (const bool velocities : {true, false}) {
        layout.velocities = velocities;
        const pid_t child = ::fork();
        if (child == 0) {
            const auto writer = make_cache_writer(file("skirt.pvd"), layout);
            write_frames(*writer, 0, 6, 7);
            ::raise(SIGKILL);
        }
        ::waitpid(child, nullptr, 0);
        const std::string list = bytes_of(file("skirt.partial/skirt.pvd"));
        EXPECT_EQ(entries(list), velocities ? 5 : 6);
        EXPECT_TRUE(list.ends_with("</Collection>\n</VTKFile>\n"));
        for (int k = 0; k < entries(list); ++k)
            EXPECT_EQ(vectors(array(bytes_of(file("skirt.partial/skirt_000" + std::to_string(k) + ".vtu")),
                                    "Points")),
                      frame_positions(k, 7));
        EXPECT_FALSE(std::filesystem::exists(file("skirt.pvd")));
    }
}

TEST_F(VtkTest, RemovesTheTailOfALongerEarlierRun)
{
    write(cache_layout(quad_mesh(), 5));
    write(cache_layout(quad_mesh(), 3));
    EXPECT_FALSE(std::filesystem::exists(file("skirt_0003.vtu")));
    EXPECT_EQ(entries(bytes_of(file("skirt.pvd"))), 3);
}

TEST_F(VtkTest, RefusesWhatItCannotDo)
{
    CacheLayout layout = cache_layout(quad_mesh(), 5);
    EXPECT_THAT(refusal([&] { make_cache_writer(file("skirt_##.pvd"), layout); }),
                HasSubstr("leave out the #"));
    layout.resume_at = 2;
    EXPECT_THAT(refusal([&] { make_cache_writer(file("skirt.pvd"), layout); }),
                HasSubstr("start the run anew"));
    layout.resume_at = 0;
    layout.start_frame = 0.5;
    EXPECT_THAT(refusal([&] { make_cache_writer(file("skirt.pvd"), layout); }),
                HasSubstr("must be a whole number"));
}

} // namespace
} // namespace toile::test
