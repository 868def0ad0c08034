#include "garment/energy/strain_limit/strain_limit.h"

#include <cmath>
#include <limits>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "garment/energy/membrane.h"
#include "garment/energy/principal_stretch.h"
#include "garment/energy/strain_limit/joint_strain_limit.h"
#include "tests/garment/sheets.h"
#include "tests/garment/touching_plane.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kLimit = 0.05;
constexpr double kTolerance = 1e-3; // as in StrainLimit::Settings

std::vector<double> inverse_of(std::vector<double> masses)
{
    for (double& mass : masses)
        mass = 1.0 / mass;
    return masses;
}

/// Sheet of uneven density, so that masses matter.
struct HeavySheet {
    Sheet sheet = make_sheet(Vec2(0.3, 0.2), 12, 8, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<double> masses = masses_of(*rest, 0.2);
    StrainLimit limit{rest, StrainLimit::Settings{kLimit}, "sheet"};
    StrainLimit patient{rest, StrainLimit::Settings{kLimit, kTolerance, 1000},
                        "sheet"}; ///< with enough sweeps to propagate corrections far

    HeavySheet()
    {
        for (size_t v = 0; v < masses.size(); ++v)
            masses[v] *= 1.0 + 0.5 * std::sin(3.0 * double(v));
    }
    Vec3 moment(const std::vector<Vec3>& x) const
    {
        Vec3 sum = Vec3::Zero();
        for (size_t v = 0; v < x.size(); ++v)
            sum += masses[v] * x[v];
        return sum;
    }
};

/// Positions scaled along u and v and rolled around an axis, which adds no stretch.
std::vector<Vec3> stretched(const Sheet& sheet, double along_u, double along_v)
{
    std::vector<Vec3> x;
    for (const Vec2& p : sheet.uv) {
        const double angle = along_u * p.x() / 0.1;
        x.emplace_back(0.1 * std::sin(angle), -0.1 * std::cos(angle), along_v * p.y());
    }
    return x;
}

TEST(PrincipalStretch, FindsTheSingularValues)
{
    Mat32 F;
    F << 1.1, 0.3, -0.2, 0.9, 0.1, 0.4;
    const PrincipalStretch stretch = principal_stretch(F);
    const Eigen::Vector2d sigma = F.jacobiSvd().singularValues();
    EXPECT_LT((stretch.sigma - sigma).norm(), 1e-14);
    EXPECT_NEAR(largest_stretch(F), sigma[0], 1e-14);
    EXPECT_LT((stretch.V.transpose() * stretch.V - Mat2::Identity()).norm(), 1e-14);
    for (int k = 0; k < 2; ++k)
        EXPECT_NEAR((F * stretch.V.col(k)).norm(), sigma[k], 1e-14);
}

TEST(StrainLimit, MeasuresTheLargestPrincipalStretch)
{
    const HeavySheet heavy;
    EXPECT_NEAR(heavy.limit.max_strain(heavy.sheet.flat()), 0.0, 1e-14);
    std::vector<Vec3> x = heavy.sheet.flat();
    for (Vec3& p : x)
        p = Vec3(1.2 * p.x(), 0.0, 0.7 * p.z());
    EXPECT_NEAR(heavy.limit.max_strain(x), 0.2, 1e-13);
}

TEST(StrainLimit, LimitsAStretchedSheet)
{
    HeavySheet heavy;
    std::vector<Vec3> x = stretched(heavy.sheet, 1.15, 1.1);
    ASSERT_GT(heavy.limit.max_strain(x), 0.14);
    heavy.patient.project(x, inverse_of(heavy.masses), nullptr);
    EXPECT_LE(heavy.limit.max_strain(x), kLimit + kTolerance);
    EXPECT_GT(heavy.limit.max_strain(x), kLimit - kTolerance) << "no more than needed";
}

/// The second sheet is stretched, and the contact projection after its sweep stretches the first.
TEST(JointStrainLimit, LimitsClothStretchedByContact)
{
    HeavySheet heavy;
    StrainLimit other(heavy.rest, StrainLimit::Settings{kLimit, kTolerance, 1000}, "other");
    const int n = heavy.rest->vertex_count();
    JointStrainLimit joint({{&heavy.patient, 0, n}, {&other, n, n}});
    std::vector<Vec3> x = heavy.sheet.flat();
    for (const Vec3& p : stretched(heavy.sheet, 1.15, 1.0))
        x.push_back(p);
    std::vector<double> inverse_masses = inverse_of(heavy.masses);
    inverse_masses.insert(inverse_masses.end(), inverse_masses.begin(), inverse_masses.begin() + n);
    int clearings = 0;
    joint.project(x, inverse_masses, [&] {
        if (++clearings == 1)
            x[heavy.sheet.at(0, 0)] += Vec3(-0.01, 0.0, 0.0);
        return clearings == 1;
    });
    EXPECT_GT(clearings, 1);
    EXPECT_LE(joint.max_strain(x), kLimit + kTolerance);
}

TEST(StrainLimit, KeepsTheMassWeightedMomentum)
{
    HeavySheet heavy;
    const std::vector<Vec3> start = stretched(heavy.sheet, 1.3, 0.9);
    std::vector<Vec3> x = start;
    heavy.limit.project(x, inverse_of(heavy.masses), nullptr);
    EXPECT_NE(x, start);
    EXPECT_LT((heavy.moment(x) - heavy.moment(start)).norm(), 1e-12 * heavy.moment(start).norm());
}

TEST(StrainLimit, LeavesASatisfiedSheetUnchangedBitwise)
{
    HeavySheet heavy;
    const std::vector<Vec3> start = stretched(heavy.sheet, 1.049, 0.5);
    std::vector<Vec3> x = start;
    heavy.limit.project(x, inverse_of(heavy.masses), nullptr);
    EXPECT_EQ(x, start);
}

TEST(StrainLimit, MovesNoTriangleFarFromTheViolation)
{
    // One stretched edge: the far side of the sheet is unchanged.
    HeavySheet heavy;
    std::vector<Vec3> x = heavy.sheet.flat();
    x[heavy.sheet.at(0, 0)] += Vec3(-0.01, 0.0, 0.0);
    const std::vector<Vec3> start = x;
    heavy.limit.project(x, inverse_of(heavy.masses), nullptr);
    EXPECT_LE(heavy.limit.max_strain(x), kLimit + kTolerance);
    for (int row = 0; row <= 8; ++row)
        EXPECT_EQ(x[heavy.sheet.at(12, row)], start[heavy.sheet.at(12, row)]);
}

TEST(StrainLimit, DoesNotMoveFixedVertices)
{
    HeavySheet heavy;
    std::vector<Vec3> x = stretched(heavy.sheet, 1.15, 1.0);
    std::vector<double> inverse = inverse_of(heavy.masses);
    for (int row = 0; row <= 8; ++row)
        inverse[heavy.sheet.at(0, row)] = 0.0;
    const std::vector<Vec3> start = x;
    heavy.patient.project(x, inverse, nullptr);
    for (int row = 0; row <= 8; ++row)
        EXPECT_EQ(x[heavy.sheet.at(0, row)], start[heavy.sheet.at(0, row)]);
    EXPECT_LE(heavy.limit.max_strain(x), kLimit + kTolerance);
}

TEST(StrainLimit, EndsWhenTheLimitCannotBeReached)
{
    // Both ends fixed 20 % too far apart: the free part shares the strain and nothing grows.
    HeavySheet heavy;
    std::vector<Vec3> x = heavy.sheet.flat();
    std::vector<double> inverse = inverse_of(heavy.masses);
    for (Vec3& p : x)
        p.x() *= 1.2;
    for (int row = 0; row <= 8; ++row)
        inverse[heavy.sheet.at(0, row)] = inverse[heavy.sheet.at(12, row)] = 0.0;
    const std::vector<Vec3> start = x;
    heavy.limit.project(x, inverse, nullptr);
    EXPECT_LE(heavy.limit.max_strain(x), 0.21) << "the strain stays where it was";
    for (size_t v = 0; v < x.size(); ++v) {
        EXPECT_TRUE(x[v].allFinite());
        EXPECT_LT((x[v] - start[v]).norm(), 0.06) << "no further than the cloth is too long";
    }

    const auto everything_fixed = std::vector<double>(x.size(), 0.0);
    std::vector<Vec3> held = start;
    heavy.limit.project(held, everything_fixed, nullptr);
    EXPECT_EQ(held, start);
}

TEST(StrainLimit, SurvivesClothCollapsedToALine)
{
    HeavySheet heavy;
    std::vector<Vec3> x = heavy.sheet.flat();
    for (Vec3& p : x)
        p = Vec3(1.1 * p.x(), 0.0, 0.0);
    heavy.patient.project(x, inverse_of(heavy.masses), nullptr);
    EXPECT_LE(heavy.limit.max_strain(x), kLimit + kTolerance);
}

/// Resets the first columns of vertices to their start, once in a step, and counts the calls.
class LimitsOnce : public TouchingPlane {
public:
    LimitsOnce(std::vector<Vec3> start, double up_to)
        : TouchingPlane({}, int(start.size())), start_(std::move(start)), up_to_(up_to)
    {
    }
    bool keep_apart(StepField positions, StepField) override
    {
        if (asked_++ > 0)
            return false;
        const View<Vec3> x = positions.change_on_host();
        for (int v = 0; v < x.size(); ++v)
            if (start_[v].x() < up_to_)
                x[v] = start_[v];
        return true;
    }
    int asked() const { return asked_; }

private:
    std::vector<Vec3> start_;
    double up_to_; ///< [m]
    int asked_ = 0;
};

TEST(StrainLimit, PullsClampedTrianglesThroughTheTension)
{
    HeavySheet heavy;
    const std::vector<Vec3> flat = heavy.sheet.flat();
    std::vector<std::shared_ptr<Energy>> energies{
        std::make_shared<Membrane>(heavy.rest, Membrane::Settings{300.0, 300.0, 100.0}, "sheet")};
    Body body(flat, std::make_unique<System>(heavy.masses, energies), {});
    body.set_velocities(std::vector<Vec3>(flat.size(), Vec3::UnitX()));
    LimitsOnce active(flat, 0.02);
    const double dt = 0.02;
    body.step(dt, std::vector<Vec3>(flat.size(), Vec3::Zero()), std::vector<unsigned char>(flat.size(), 0),
              flat, &active, &heavy.patient);

    EXPECT_EQ(active.asked(), 2);
    EXPECT_LT(heavy.limit.max_strain(body.positions()), kLimit + kTolerance);
    const int border = heavy.sheet.at(0, 4);
    EXPECT_GT(body.positions()[border].x() - flat[border].x(), 0.5 * dt);
}

TEST(StrainLimit, RefusesALimitThatIsNotPositive)
{
    const auto rest = make_sheet(Vec2(0.1, 0.1), 1, 1).rest();
    for (const double limit : {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity()})
        try {
            StrainLimit strain_limit(rest, StrainLimit::Settings{limit}, "silk");
            ADD_FAILURE() << limit << " was accepted";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(std::string(error.what()).find("silk: strain limit "), 0u) << error.what();
        }
}

} // namespace
} // namespace toile::test
