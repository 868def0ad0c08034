#include "volume/energy/harmonic.h"

#include <gtest/gtest.h>

#include "tests/volume/blocks.h"

namespace toile::test {

TEST(ExtendHarmonically, ContinuesLinearFunctionsExactly)
{
    const Block block = make_block(Vec3(0.3, 0.2, 0.1), {5, 4, 3}, 0.2);
    Mat3 gradient;
    gradient << 1, 2, 3, -4, 5, 6, 7, 8, -9;
    std::vector<Vec3> values(block.mesh.positions.size(), Vec3::Constant(1e3));
    std::vector<char> is_given(values.size(), 0);
    int inside = 0;
    for (int v = 0; v < block.mesh.vertex_count(); ++v) {
        is_given[v] = char(block.is_on_surface(v));
        inside += 1 - is_given[v];
        if (is_given[v])
            values[v] = gradient * block.mesh.positions[v];
    }
    EXPECT_GT(inside, 0);
    volume::extend_harmonically(block.mesh, is_given, values);
    for (int v = 0; v < block.mesh.vertex_count(); ++v)
        EXPECT_LT((values[v] - gradient * block.mesh.positions[v]).norm(), 1e-5) << v;
}

TEST(ExtendHarmonically, LeavesAMeshWithoutInsideAsItIs)
{
    const Block block = make_block(Vec3::Ones(), {1, 1, 1});
    std::vector<Vec3> values = block.mesh.positions;
    volume::extend_harmonically(block.mesh, std::vector<char>(values.size(), 1), values);
    EXPECT_EQ(values, block.mesh.positions);
}

} // namespace toile::test
