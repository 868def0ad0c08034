#include "core/pd/newton/component_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::test {
namespace {

using testing::ElementsAre;

/// Vertices 0 and 1 are connected by blocks, 2 to 4 by isotropic entries.
ComponentWeights weights_of(const std::vector<double>& masses)
{
    SparseMatrix isotropic(5, 5);
    isotropic.insert(2, 3) = isotropic.insert(3, 2) = isotropic.insert(3, 4) = isotropic.insert(4, 3) = 1.0;
    return ComponentWeights(masses, BlockMatrix(5, {{0, 1}}), isotropic);
}

std::vector<double> all(const ComponentWeights& weights)
{
    return {weights.all().begin(), weights.all().end()};
}

TEST(ComponentWeights, ALightComponentCountsAsMuchAsAHeavyOne)
{
    const ComponentWeights weights = weights_of({6.0, 2.0, 0.5, 1.0, 0.5});
    EXPECT_THAT(all(weights), ElementsAre(3.75, 1.25, 1.25, 2.5, 1.25));
    EXPECT_DOUBLE_EQ(weights.mass(), 10.0);
    EXPECT_DOUBLE_EQ(weights.lightest(), 2.0 / 5.0);
}

TEST(ComponentWeights, CountFreeVerticesAlone)
{
    ComponentWeights weights = weights_of({6.0, 2.0, 0.5, 1.0, 0.5});
    weights.set_fixed(std::vector<unsigned char>{0, 0, 0, 1, 0}); // the ends remain one component
    EXPECT_THAT(all(weights), ElementsAre(3.375, 1.125, 2.25, 0.0, 2.25));
    EXPECT_DOUBLE_EQ(weights.lightest(), 1.0 / 4.5);

    weights.set_fixed(std::vector<unsigned char>{1, 1, 0, 0, 0});
    EXPECT_THAT(all(weights), ElementsAre(0.0, 0.0, 0.5, 1.0, 0.5));
    EXPECT_DOUBLE_EQ(weights.mass(), 2.0);
    EXPECT_DOUBLE_EQ(weights.lightest(), 1.0);

    weights.set_fixed(std::vector<unsigned char>(5, 1));
    EXPECT_EQ(weights.mass(), 0.0);
}

TEST(ComponentWeights, OfOneComponentAreItsMasses)
{
    const std::vector<double> masses{0.1, 0.7, 0.3};
    const ComponentWeights weights(masses, BlockMatrix(3, {{0, 1}, {1, 2}}), SparseMatrix(3, 3));
    EXPECT_THAT(all(weights), testing::ElementsAreArray(masses));
    EXPECT_EQ(weights.lightest(), 1.0);
}

} // namespace
} // namespace toile::test
