#include "garment/energy/strain_limit/cuda/strain_limit.h"

#include <algorithm>
#include <cmath>

#include "core/base/stages.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/sheets.h"

/// Strain limits on a GPU compared with the CPU.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kLimit = 0.05;
constexpr double kTolerance = 1e-3; // as in StrainLimit::Settings

/// Sheet of uneven density, so that masses matter.
struct HeavySheet {
    Sheet sheet;
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<double> inverse_masses = masses_of(*rest, 0.2);

    explicit HeavySheet(int columns = 24, int rows = 16)
        : sheet(make_sheet(Vec2(0.3, 0.2), columns, rows, Pattern::Irregular))
    {
        for (size_t v = 0; v < inverse_masses.size(); ++v)
            inverse_masses[v] = 1.0 / (inverse_masses[v] * (1.0 + 0.5 * std::sin(3.0 * double(v))));
    }
    void fix_column(int column)
    {
        for (int row = 0; row <= sheet.rows; ++row)
            inverse_masses[sheet.at(column, row)] = 0.0;
    }
    /// Positions scaled along u and v and rolled around an axis, which adds no stretch.
    std::vector<Vec3> stretched(double along_u, double along_v) const
    {
        std::vector<Vec3> x;
        for (const Vec2& p : sheet.uv) {
            const double angle = along_u * p.x() / 0.1;
            x.emplace_back(0.1 * std::sin(angle), -0.1 * std::cos(angle), along_v * p.y());
        }
        return x;
    }
    /// Positions scaled along u, and a vertex displaced by as much in two directions [m].
    std::vector<Vec3> poked(double along_u, double pull) const
    {
        std::vector<Vec3> x = stretched(along_u, 0.9);
        x[sheet.at(20, 9)] += Vec3(pull, pull, 0.0);
        return x;
    }
    StrainLimit limit(int max_sweeps, double limit = kLimit) const
    {
        return StrainLimit(rest, StrainLimit::Settings{limit, kTolerance, max_sweeps}, "sheet");
    }
};

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        max = std::max(max, (a[v] - b[v]).norm());
    return max;
}

class DeviceStrainLimitTest : public OnDevice {
protected:
    void SetUp() override
    {
        OnDevice::SetUp();
        if (IsSkipped())
            return;
        x_ = std::make_unique<DeviceArray<Vec3>>(space(), "test/x");
        inverse_masses_ = std::make_unique<DeviceArray<double>>(space(), "test/inverse_masses");
    }

    std::vector<Vec3> projected(DeviceStrainLimit& limit, const std::vector<Vec3>& x,
                                const std::vector<double>& inverse_masses,
                                const std::function<bool()>& clear_contacts = nullptr)
    {
        x_->upload(x);
        inverse_masses_->upload(inverse_masses);
        if (!limit.is_satisfied(x_->view()))
            limit.project(x_->view(), inverse_masses_->view(), clear_contacts);
        return x_->downloaded();
    }
    double max_strain(DeviceStrainLimit& limit, const std::vector<Vec3>& x)
    {
        x_->upload(x);
        limit.end_step(x_->view());
        space().synchronise();
        return limit.max_strain();
    }
    DeviceArray<Vec3>& x() { return *x_; }

private:
    std::unique_ptr<DeviceArray<Vec3>> x_;
    std::unique_ptr<DeviceArray<double>> inverse_masses_;
};

TEST_F(DeviceStrainLimitTest, SweepsAsOnTheCpu)
{
    // Few violating triangles, many, and many that become few.
    struct Case {
        int columns, rows;
        double along_u;
        int sweeps;
    };
    for (const auto& [columns, rows, along_u, sweeps] : {Case{24, 16, 1.08, 1},
                                                         {24, 16, 1.08, 2},
                                                         {24, 16, 1.08, 13},
                                                         {64, 40, 1.08, 1},
                                                         {64, 40, 1.08, 7},
                                                         {64, 40, 1.0, 30},
                                                         {64, 40, 1.052, 30}}) {
        HeavySheet heavy(columns, rows);
        heavy.fix_column(0);
        StrainLimit cpu = heavy.limit(sweeps);
        DeviceStrainLimit gpu(space());
        gpu.add(cpu, 0);
        std::vector<Vec3> x = heavy.poked(along_u, 0.01);
        const std::vector<Vec3> start = x;
        const std::vector<Vec3> y = projected(gpu, x, heavy.inverse_masses);
        cpu.project(x, heavy.inverse_masses, nullptr);
        EXPECT_GT(max_distance(x, start), 1e-3) << columns << " columns, " << sweeps << " sweeps";
        EXPECT_LT(max_distance(x, y), 1e-11) << columns << " columns, " << sweeps << " sweeps";
        for (int row = 0; row <= rows; ++row)
            EXPECT_EQ(y[heavy.sheet.at(0, row)], start[heavy.sheet.at(0, row)]);
        EXPECT_NEAR(max_strain(gpu, y), cpu.max_strain(y), 1e-12 * (1.0 + cpu.max_strain(y)));
    }
}

TEST_F(DeviceStrainLimitTest, LimitsAStretchedSheet)
{
    const HeavySheet heavy;
    const StrainLimit cpu = heavy.limit(3000);
    DeviceStrainLimit gpu(space());
    gpu.add(cpu, 0);
    for (const double along_v : {1.0, 0.0}) { // also collapsed to a line
        const std::vector<Vec3> y = projected(gpu, heavy.stretched(1.08, along_v), heavy.inverse_masses);
        EXPECT_LE(cpu.max_strain(y), kLimit + kTolerance);
        EXPECT_GT(cpu.max_strain(y), kLimit - kTolerance) << "no more than needed";
    }
}

TEST_F(DeviceStrainLimitTest, LeavesClothWithinItsLimitUnchanged)
{
    const HeavySheet heavy;
    DeviceStrainLimit gpu(space());
    gpu.add(heavy.limit(100), 0);
    const std::vector<Vec3> x = heavy.stretched(1.03, 0.5);
    Stages stages;
    {
        const Stages::Activate activate(stages);
        EXPECT_EQ(projected(gpu, x, heavy.inverse_masses), x);
    }
    EXPECT_EQ(stages.calls("garment/strain_limit"), 0);
    EXPECT_EQ(stages.calls("strain_limit/find"), 1);
    EXPECT_EQ(stages.calls("strain_limit/clamp"), 0);
}

TEST_F(DeviceStrainLimitTest, KeepsClothsApart)
{
    // Vertices of no cloth, a sheet within its limit, then the same beyond a stricter one.
    const HeavySheet heavy;
    const int gap = 5, n = heavy.rest->vertex_count();
    const StrainLimit loose = heavy.limit(4, 0.6);
    StrainLimit strict = heavy.limit(4, 0.01);
    DeviceStrainLimit gpu(space());
    gpu.add(loose, gap);
    gpu.add(strict, gap + n);
    const std::vector<Vec3> heavy_x = heavy.poked(1.0, 0.002);
    std::vector<Vec3> x(gap, Vec3(1.0, 2.0, 3.0));
    std::vector<double> inverse_masses(gap, 1.0);
    for (int k = 0; k < 2; ++k) {
        x.insert(x.end(), heavy_x.begin(), heavy_x.end());
        inverse_masses.insert(inverse_masses.end(), heavy.inverse_masses.begin(), heavy.inverse_masses.end());
    }
    const std::vector<Vec3> y = projected(gpu, x, inverse_masses);
    EXPECT_TRUE(std::equal(y.begin(), y.begin() + gap + n, x.begin()));
    std::vector<Vec3> expected = heavy_x;
    strict.project(expected, heavy.inverse_masses, nullptr);
    ASSERT_NE(expected, heavy_x);
    EXPECT_LT(max_distance({y.begin() + gap + n, y.end()}, expected), 1e-11);
    EXPECT_NEAR(max_strain(gpu, y), std::max(loose.max_strain(heavy_x), strict.max_strain(expected)), 1e-11);
}

TEST_F(DeviceStrainLimitTest, RevertsProjectionsThatIncreaseTheStrain)
{
    // A sliver on the border of a clamped triangle: a correction of the one overstretches the other.
    const std::vector<Vec2> uv{{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.1}, {0.0, 0.1}, {0.05, -0.0002}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};
    const auto rest = std::make_shared<const RestShape>(rest_shape_of_pattern(uv, triangles, "test"));
    ASSERT_TRUE(rest->is_sliver(2));
    StrainLimit cpu(rest, StrainLimit::Settings{kLimit}, "test");
    DeviceStrainLimit gpu(space());
    gpu.add(cpu, 0);
    std::vector<Vec3> x;
    x.reserve(uv.size());
    for (const Vec2& p : uv)
        x.emplace_back(p.x(), 0.0, p.y());
    const std::vector<double> inverse_masses(5, 1.0);

    std::vector<Vec3> thin = x;
    thin[4].z() = -0.002;
    EXPECT_GT(max_strain(gpu, thin), 1.0);
    EXPECT_EQ(projected(gpu, thin, inverse_masses), thin) << "the sliver alone is not clamped";

    x[3].z() += 0.02;
    std::vector<Vec3> expected = x;
    cpu.project(expected, inverse_masses, nullptr);
    ASSERT_EQ(expected, x);
    Stages stages;
    {
        const Stages::Activate activate(stages);
        EXPECT_EQ(projected(gpu, x, inverse_masses), x);
    }
    EXPECT_GT(stages.calls("garment/strain_limit"), 0) << "it was clamped";

    const std::vector<double> all_fixed(5, 0.0);
    EXPECT_EQ(projected(gpu, x, all_fixed), x);
}

TEST_F(DeviceStrainLimitTest, ClearsContactsInTheFirstSweeps)
{
    HeavySheet heavy;
    heavy.fix_column(0);
    heavy.fix_column(heavy.sheet.columns);
    std::vector<Vec3> x = heavy.sheet.flat();
    for (Vec3& p : x)
        p.x() *= 1.2; // fixed too far apart: the limit cannot be reached
    DeviceStrainLimit gpu(space());
    gpu.add(heavy.limit(40), 0);
    int asked = 0;
    Stages stages;
    {
        const Stages::Activate activate(stages);
        projected(gpu, x, heavy.inverse_masses, [&] { return ++asked % 2 == 0; });
    }
    EXPECT_EQ(asked, StrainLimit::kSweepsWithContact);
    EXPECT_EQ(stages.calls("garment/strain_limit"), 40);

    // A contact projection that satisfies the limit ends the sweeps.
    const std::vector<Vec3> flat = heavy.sheet.flat();
    asked = 0;
    const std::vector<Vec3> y = projected(gpu, x, heavy.inverse_masses, [&] {
        ++asked;
        this->x().upload(flat);
        return true;
    });
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(y, flat);
}

TEST_F(DeviceStrainLimitTest, HasTheSameBitsTwiceAndAllocatesNothingOnceWarm)
{
    const HeavySheet heavy;
    const std::vector<Vec3> x = heavy.poked(1.08, 0.01);
    DeviceStrainLimit first(space()), second(space());
    first.add(heavy.limit(50), 0);
    second.add(heavy.limit(50), 0);
    const std::vector<Vec3> once = projected(first, x, heavy.inverse_masses);
    EXPECT_NE(once, x);
    EXPECT_EQ(allocations_of([&] { EXPECT_EQ(projected(first, x, heavy.inverse_masses), once); }), 0);
    EXPECT_EQ(projected(second, x, heavy.inverse_masses), once);
}

} // namespace
} // namespace toile::test
