#include "core/quadrature/tables/table_cache.h"

#include <chrono>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/stages.h"
#include "core/quadrature/quadrature_solver.h"
#include "core/quadrature/tables/table_store.h"
#include "tests/core/quadrature/quadrature_problems.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

/// A small body and a private folder.
class TableCacheTest : public FileTest {
protected:
    TableInput input() const { return {H_, fixed_, points_, {}}; }
    std::filesystem::path table() const { return TableCache(folder_).file_of(table_key(input())); }

    /// Tables of a separate run: a new store on the same folder.
    std::shared_ptr<const QuadratureTables> run(std::uintmax_t limit = TableCache::kByteLimit)
    {
        Stages stages;
        const Stages::Activate recording(stages);
        warnings_.clear();
        TableStore store(folder_, limit);
        auto tables =
            store.get(input(), {nullptr, [&](const std::string& warning) { warnings_.push_back(warning); }});
        builds_ = stages.calls("quadrature/build");
        return tables;
    }

    /// Changes to another body with a table of the same size.
    void change_body() { H_.valuePtr()[0] += 0.125; }

    std::vector<EmbeddedPoint> points_ = grid_points(17, 13);
    std::vector<unsigned char> fixed_ = std::vector<unsigned char>(points_.size(), 0);
    SparseMatrix H_ = grid_laplacian(17, 13, 1e-3);
    std::vector<std::string> warnings_;
    long builds_ = 0;
};

std::vector<Vec3> solved(const std::shared_ptr<const QuadratureTables>& tables)
{
    const std::vector<Vec3> b = random_field(17 * 13, 6);
    std::vector<Vec3> x(b.size());
    QuadratureOperator(tables).solve(b, x);
    return x;
}

TEST_F(TableCacheTest, ReadsTheTablesOfAnEarlierRun)
{
    const std::vector<Vec3> built = solved(run());
    EXPECT_EQ(builds_, 1);
    const std::vector<Vec3> read = solved(run());
    EXPECT_EQ(builds_, 0);
    EXPECT_EQ(read, built) << "bit by bit";
    change_body();
    run();
    EXPECT_EQ(builds_, 1);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(TableCacheTest, RebuildsWhenAnyByteIsDamaged)
{
    run();
    const std::string good = bytes_of(table());
    // Each field of the header, then each array from its start to the file's end.
    std::vector<size_t> offsets{0, 7, 8, 12, 16, 31, 32, 47, 48, 56, 64, 72, 80, 95, 96, 120};
    for (size_t at = 200; at < good.size(); at += good.size() / 20)
        offsets.push_back(at);
    offsets.push_back(good.size() - 1);
    for (const size_t at : offsets) {
        std::string bad = good;
        bad[at] = char(bad[at] ^ 0x10);
        std::ofstream(table(), std::ios::binary) << bad;
        run();
        EXPECT_EQ(builds_, 1) << "byte " << at;
        const bool is_version = at >= 8 && at < 16;
        EXPECT_EQ(warnings_.size(), is_version ? 0u : 1u) << "byte " << at;
        if (!warnings_.empty()) {
            EXPECT_EQ(warnings_[0].rfind(table().string() + ": ", 0), 0u) << warnings_[0];
        }
        EXPECT_EQ(bytes_of(table()), good) << "byte " << at;
    }
}

TEST_F(TableCacheTest, RebuildsWhenTheFileIsTruncatedOrTooLong)
{
    run();
    const std::string good = bytes_of(table());
    for (const size_t size :
         {size_t(0), size_t(7), size_t(95), size_t(96), good.size() / 2, good.size() - 1}) {
        std::ofstream(table(), std::ios::binary) << good.substr(0, size);
        run();
        EXPECT_EQ(builds_, 1) << size;
        EXPECT_EQ(warnings_.size(), 1u) << size;
    }
    std::ofstream(table(), std::ios::binary) << good << "x";
    run();
    EXPECT_EQ(builds_, 1);
}

TEST_F(TableCacheTest, AllocatesNothingForImpossibleSizes)
{
    run();
    const std::string good = bytes_of(table());
    for (const size_t field : {56, 64, 72}) { // leaves, near entries, far entries
        std::string bad = good;
        const std::uint64_t huge = std::uint64_t(1) << 61;
        std::memcpy(bad.data() + field, &huge, sizeof huge);
        std::ofstream(table(), std::ios::binary) << bad;
        run();
        EXPECT_EQ(builds_, 1) << field;
        EXPECT_EQ(warnings_.size(), 1u) << field;
    }
}

TEST_F(TableCacheTest, ReplacesAnotherVersionSilently)
{
    run();
    const std::string good = bytes_of(table());
    std::string old = good;
    old[8] = 0;
    std::ofstream(table(), std::ios::binary) << old;
    run();
    EXPECT_EQ(builds_, 1);
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(bytes_of(table()), good);
}

TEST_F(TableCacheTest, FindsNothingInADamagedFileAndBuildsNothing)
{
    run();
    Stages stages;
    const Stages::Activate recording(stages);
    EXPECT_NE(TableStore(folder_).find(input()), nullptr);
    const std::string good = bytes_of(table());
    std::ofstream(table(), std::ios::binary) << good.substr(0, good.size() / 2);
    TableStore store(folder_);
    EXPECT_TRUE(store.contains(input()));
    EXPECT_EQ(store.find(input()), nullptr);
    EXPECT_EQ(stages.calls("quadrature/build"), 0);
    EXPECT_NE(store.get(input()), nullptr) << "the next one builds";
    EXPECT_EQ(stages.calls("quadrature/build"), 1);
}

TEST_F(TableCacheTest, LeavesForeignFiles)
{
    const std::vector<std::filesystem::path> others{folder_ / "seating.tables",
                                                    folder_ / "skirt.pc2.partial-7"};
    for (const std::filesystem::path& other : others) {
        std::ofstream(other) << "not ours";
        std::filesystem::last_write_time(other, std::filesystem::file_time_type::clock::now() -
                                                    std::chrono::hours(100));
    }
    run();
    const std::filesystem::path first = table();
    std::filesystem::last_write_time(first,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(3));
    change_body();
    run(std::filesystem::file_size(first) * 3 / 2);
    EXPECT_FALSE(std::filesystem::exists(first));
    for (const std::filesystem::path& other : others)
        EXPECT_TRUE(std::filesystem::exists(other)) << other;
}

TEST_F(TableCacheTest, RefusesTheTablesOfAnotherKey)
{
    run();
    const std::filesystem::path first = table();
    change_body();
    std::filesystem::copy_file(first, table());
    run();
    EXPECT_EQ(builds_, 1);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("another key"), std::string::npos);
}

TEST_F(TableCacheTest, AcceptsConcurrentWriters)
{
    const auto tables = build_tables(input(), nullptr);
    const Hash128 key = table_key(input());
    const auto write_often = [&] {
        TableCache cache(folder_);
        for (int k = 0; k < 20; ++k)
            cache.store(key, *tables, [](const std::string& warning) { ADD_FAILURE() << warning; });
    };
    const pid_t other_process = ::fork();
    if (other_process == 0) {
        write_often();
        ::_exit(testing::Test::HasFailure() ? 1 : 0);
    }
    std::vector<std::thread> threads(2);
    for (std::thread& thread : threads)
        thread = std::thread(write_often);
    for (int k = 0; k < 20; ++k) { // a reader finds all or nothing
        run();
        EXPECT_TRUE(warnings_.empty());
    }
    for (std::thread& thread : threads)
        thread.join();
    int status = 0;
    ::waitpid(other_process, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "nothing half-written";
    run();
    EXPECT_EQ(builds_, 0);
}

TEST_F(TableCacheTest, EvictsTheLeastRecentlyUsed)
{
    run();
    const auto size = std::filesystem::file_size(table());
    const std::uintmax_t capacity_for_two = 2 * size + size / 2;
    const std::filesystem::path first = table();
    SparseMatrix first_H = H_;
    change_body();
    run(capacity_for_two);
    const std::filesystem::path second = table();
    const auto now = std::filesystem::file_time_type::clock::now();
    std::filesystem::last_write_time(first, now - std::chrono::hours(3));
    std::filesystem::last_write_time(second, now - std::chrono::hours(2));

    std::swap(H_, first_H);
    run(capacity_for_two); // a hit: the first table is now the most recently used
    EXPECT_EQ(builds_, 0);
    change_body();
    change_body();
    run(capacity_for_two);
    EXPECT_TRUE(std::filesystem::exists(first));
    EXPECT_FALSE(std::filesystem::exists(second));
    EXPECT_TRUE(std::filesystem::exists(table()));
}

TEST_F(TableCacheTest, DoesNotKeepTablesLargerThanTheLimit)
{
    run(1000);
    EXPECT_FALSE(std::filesystem::exists(table()));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(TableCacheTest, WorksWithoutAWritableFolder)
{
    std::ofstream(folder_ / "taken") << "a file where the folder should be";
    TableStore store(folder_ / "taken");
    std::vector<std::string> warnings;
    const TableListener listener{nullptr, [&](const std::string& warning) { warnings.push_back(warning); }};
    for (int k = 0; k < 3; ++k) {
        EXPECT_NE(store.get(input(), listener), nullptr);
        change_body();
    }
    EXPECT_EQ(warnings.size(), 1u);
}

TEST(TableCacheFolder, IsTheFirstThatTheEnvironmentNames)
{
    const auto folder_with = [](const char* cache_dir, const char* xdg, const char* home) {
        const pid_t process = ::fork(); // a child process, because the environment is shared by all tests
        if (process == 0) {
            const auto set = [](const char* name, const char* value) {
                value ? ::setenv(name, value, 1) : ::unsetenv(name);
            };
            set("TOILE_CACHE_DIR", cache_dir);
            set("XDG_CACHE_HOME", xdg);
            set("HOME", home);
            const std::string folder = default_cache_folder().string();
            ::_exit(folder == "/own"                 ? 1
                    : folder == "/xdg/toile"         ? 2
                    : folder == "/home/.cache/toile" ? 3
                    : folder.empty()                 ? 4
                                                     : 5);
        }
        int status = 0;
        ::waitpid(process, &status, 0);
        return WEXITSTATUS(status);
    };
    EXPECT_EQ(folder_with("/own", "/xdg", "/home"), 1);
    EXPECT_EQ(folder_with(nullptr, "/xdg", "/home"), 2);
    EXPECT_EQ(folder_with(nullptr, nullptr, "/home"), 3);
    EXPECT_EQ(folder_with(nullptr, "relative", "/home"), 3);
    EXPECT_EQ(folder_with("", "/xdg", "/home"), 4);
    EXPECT_EQ(folder_with(nullptr, nullptr, nullptr), 4);
}

} // namespace
} // namespace toile::test
