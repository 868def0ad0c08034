#include <gtest/gtest.h>

#include <memory>

#include "garment/energy/bending.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

/// Energy over the exact one, rigidity x area x twist^2, of a strip twisted as a whole: w = twist u v. No
/// moment acts on its free edges in this state.
double relative_energy(const Vec2& size, int columns, int rows, Pattern pattern)
{
    constexpr double kRigidity = 1e-5, kTwist = 0.5; // [N m], [1/m]
    const Sheet sheet = make_sheet(size, columns, rows, pattern);
    Bending bending(sheet.rest(), Bending::Settings{kRigidity, kRigidity}, "strip");
    std::vector<Vec3> x = sheet.flat();
    for (size_t i = 0; i < x.size(); ++i)
        x[i] = Vec3(0.0, kTwist * sheet.uv[i].x() * (sheet.uv[i].y() - 0.5 * size.y()), 0.0);
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    return bending.add_gradient(x, gradient) / (kRigidity * size.x() * size.y() * kTwist * kTwist);
}

TEST(Torsion, OfAStripIsExactOnRegularMeshes)
{
    for (const Pattern pattern : {Pattern::Regular, Pattern::FlippedDiagonal})
        for (const int rows : {1, 2, 4, 8})
            EXPECT_NEAR(relative_energy({0.1, 0.02}, 5 * rows, rows, pattern), 1.0, 0.01)
                << rows << " cells across";
}

TEST(Torsion, OfAStripIsRightOnIrregularMeshes)
{
    // Meshes without slivers, whose planes are ill-defined.
    for (const int rows : {4, 6, 16})
        EXPECT_NEAR(relative_energy({0.1, 0.02}, 5 * rows, rows, Pattern::Irregular), 1.0, 0.03)
            << rows << " cells across";
}

} // namespace
} // namespace toile::test
