#include <cmath>
#include <random>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gmock/gmock.h>

#include "export/gltf/glb_mesh.h"
#include "tests/export/export_fixtures.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace exports;

namespace {

using testing::HasSubstr;

/// Three motions at once, each of its own direction at each vertex.
std::vector<Vec3> wave(int frame, int vertex_count)
{
    std::vector<Vec3> x;
    for (int v = 0; v < vertex_count; ++v)
        x.push_back(Vec3(v % 3 + 0.3 * std::sin(0.1 * frame) * v,
                         v / 3 + 0.2 * std::cos(0.3 * frame) * (v % 2),
                         0.25 * v + 0.1 * std::sin(0.2 * frame) * std::cos(v)));
    return x;
}

Vec3 vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

class GlbTest : public ExportTest {
protected:
    /// Writes the frames of `positions`. @return the writer's note
    std::string written(const CacheLayout& layout,
                        const std::function<std::vector<Vec3>(int)>& positions) const
    {
        const auto writer = make_cache_writer(file("skirt.glb"), layout);
        for (int frame = 0; frame < layout.frame_count; ++frame)
            writer->write(frame, positions(frame));
        writer->finish();
        return writer->note();
    }

    const aiScene& read()
    {
        const aiScene* scene = importer_.ReadFile(file("skirt.glb").string(), 0);
        if (scene == nullptr)
            throw std::runtime_error(importer_.GetErrorString());
        return *scene;
    }

    /// Positions of a mesh's vertices in a frame, as assimp has them.
    static std::vector<Vec3> played(const aiScene& scene, unsigned mesh, unsigned frame)
    {
        const aiMesh& shape = *scene.mMeshes[mesh];
        const aiMeshMorphKey& key = scene.mAnimations[0]->mMorphMeshChannels[mesh]->mKeys[frame];
        std::vector<Vec3> x;
        for (unsigned v = 0; v < shape.mNumVertices; ++v) {
            const Vec3 base = vector(shape.mVertices[v]);
            Vec3 at = base;
            for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k)
                at += key.mWeights[k] * (vector(shape.mAnimMeshes[key.mValues[k]]->mVertices[v]) - base);
            x.push_back(at);
        }
        return x;
    }

    Assimp::Importer importer_;
};

TEST_F(GlbTest, PlaysInAnotherReaderWithinTheErrorThatItSays)
{
    CacheLayout layout = cache_layout(quad_mesh(), 60);
    layout.fps = 25.0;
    const std::string note = written(layout, [](int frame) { return wave(frame, 7); });
    EXPECT_THAT(note, HasSubstr("3 shapes, largest error "));

    const aiScene& scene = read();
    ASSERT_EQ(scene.mNumMeshes, 1u);
    ASSERT_EQ(scene.mNumAnimations, 1u);
    const aiMeshMorphAnim& weights = *scene.mAnimations[0]->mMorphMeshChannels[0];
    ASSERT_EQ(weights.mNumKeys, 60u);
    EXPECT_NEAR(weights.mKeys[59].mTime, 59 * 1000.0 / 25.0, 1e-2); // [ms] by assimp
    const std::vector<int> vertices = glb_mesh(quad_mesh(), quad_mesh().positions).vertices;
    for (unsigned frame = 0; frame < 60; ++frame) {
        const std::vector<Vec3> x = played(scene, 0, frame), expected = wave(int(frame), 7);
        ASSERT_EQ(x.size(), vertices.size());
        for (size_t v = 0; v < x.size(); ++v)
            EXPECT_LT((x[v] - expected[size_t(vertices[v])]).norm(), 1e-3) << frame << " " << v;
    }
}

/// Eleven pairs of vertex and texture coordinates, by hand.
TEST_F(GlbTest, SplitsVerticesAtSeamsOfTheTexture)
{
    const ObjMesh mesh = quad_mesh();
    written(cache_layout(mesh, 1), [&](int) { return mesh.positions; });
    const aiScene& scene = read();
    const aiMesh& read_mesh = *scene.mMeshes[0];
    EXPECT_EQ(scene.mNumAnimations, 0u);
    EXPECT_EQ(read_mesh.mNumAnimMeshes, 0u);
    EXPECT_EQ(read_mesh.mNumVertices, 11u);
    ASSERT_EQ(read_mesh.mNumFaces, 5u);

    // Every triangle lies in its polygon, with the polygon's texture and orientation.
    const std::vector<int> polygon_of{0, 0, 1, 1, 2};
    for (unsigned f = 0; f < 5; ++f) {
        const size_t p = size_t(polygon_of[f]);
        Vec3 corner[3];
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned v = read_mesh.mFaces[f].mIndices[k];
            corner[k] = vector(read_mesh.mVertices[v]);
            bool found = false;
            for (size_t c = 0; c < mesh.polygons[p].size(); ++c) {
                const Vec2 uv = mesh.texture_coordinates[size_t(mesh.polygon_uvs[p][c])];
                found = found || (mesh.positions[size_t(mesh.polygons[p][c])] == corner[k] &&
                                  uv.x() == read_mesh.mTextureCoords[0][v].x &&
                                  uv.y() == read_mesh.mTextureCoords[0][v].y); // assimp has V up
            }
            EXPECT_TRUE(found) << f << " " << k;
            EXPECT_NEAR(vector(read_mesh.mNormals[v]).norm(), 1.0, 1e-6);
        }
        EXPECT_GT((corner[1] - corner[0]).cross(corner[2] - corner[0]).z(), 0.0);
    }
}

TEST_F(GlbTest, HoldsSeveralMeshesInMetresWithYUp)
{
    CacheLayout layout = cache_layout(quad_mesh(), 30);
    layout.meshes.push_back(layout.meshes.front());
    layout.meshes[0].name = "skirt";
    layout.meshes[1].name = "caf\xe9"; // no UTF-8
    layout.axes = {"cm", "z"};
    written(layout, [](int frame) {
        std::vector<Vec3> x = wave(frame, 14);
        change_axes(Axes{}, Axes{"cm", "z"}, x);
        return x;
    });
    const aiScene& scene = read();
    ASSERT_EQ(scene.mNumMeshes, 2u);
    ASSERT_EQ(scene.mAnimations[0]->mNumMorphMeshChannels, 2u);
    EXPECT_STREQ(scene.mRootNode->mChildren[0]->mName.C_Str(), "skirt");
    const std::vector<int> vertices = glb_mesh(quad_mesh(), quad_mesh().positions).vertices;
    for (const unsigned mesh : {0u, 1u}) {
        const std::vector<Vec3> x = played(scene, mesh, 29);
        for (size_t v = 0; v < x.size(); ++v)
            EXPECT_LT((x[v] - wave(29, 14)[size_t(vertices[v]) + 7 * mesh]).norm(), 1e-3);
    }
}

TEST_F(GlbTest, RefusesWhatNeedsTooManyShapesAndProposesAnErrorThatIsEnough)
{
    constexpr int kVertices = 400, kFrames = 150;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-0.01, 0.01);
    std::vector<std::vector<Vec3>> noise(kFrames, std::vector<Vec3>(kVertices));
    for (std::vector<Vec3>& frame : noise)
        for (Vec3& x : frame)
            x = Vec3(number(random), number(random), number(random));
    ObjMesh mesh;
    mesh.positions = noise[0];
    mesh.polygons = {{0, 1, 2}};
    CacheLayout layout = cache_layout(mesh, kFrames);

    const std::string message = refusal([&] { written(layout, [&](int k) { return noise[size_t(k)]; }); });
    EXPECT_THAT(message, HasSubstr("skirt.glb: needs 14")); // of 149, one for each frame but the first
    EXPECT_THAT(message, HasSubstr("shapes for 1 mm, at most 64 are written; allow"));
    EXPECT_FALSE(std::filesystem::exists(file("skirt.glb")));
    EXPECT_EQ(read_cache(file("skirt.glb.partial.pc2")).frame_count(), kFrames);

    const std::string option = "--max-error ";
    layout.max_error = std::stod(message.substr(message.find(option) + option.size()));
    EXPECT_THAT(written(layout, [&](int k) { return noise[size_t(k)]; }),
                HasSubstr(" shapes, largest error "));
    EXPECT_FALSE(std::filesystem::exists(file("skirt.glb.partial.pc2")));
}

/// Five frames have four shapes at most.
TEST_F(GlbTest, RefusesAnErrorThatNoNumberOfShapesKeeps)
{
    CacheLayout layout = cache_layout(quad_mesh(), 5);
    layout.max_error = 1e-20;
    const std::string message = refusal([&] { written(layout, [](int frame) { return wave(frame, 7); }); });
    EXPECT_THAT(message, HasSubstr("skirt.glb: single precision holds its positions within "));
    EXPECT_THAT(message, HasSubstr(" mm, which is more than 1e-17 mm; "));
    EXPECT_FALSE(std::filesystem::exists(file("skirt.glb")));
}

TEST_F(GlbTest, ContinuesAKilledRun)
{
    CacheLayout layout = cache_layout(quad_mesh(), 9);
    {
        const auto killed = make_cache_writer(file("skirt.glb"), layout);
        for (int frame = 0; frame < 5; ++frame)
            killed->write(frame, wave(frame, 7));
    }
    layout.resume_at = 4;
    const auto writer = make_cache_writer(file("skirt.glb"), layout);
    for (int frame = 4; frame < 9; ++frame)
        writer->write(frame, wave(frame, 7));
    writer->finish();
    EXPECT_EQ(read().mAnimations[0]->mMorphMeshChannels[0]->mNumKeys, 9u);
}

TEST_F(GlbTest, RefusesAnErrorThatIsNotPositive)
{
    CacheLayout layout = cache_layout(quad_mesh(), 9);
    layout.max_error = 0.0;
    EXPECT_THAT(refusal([&] { make_cache_writer(file("skirt.glb"), layout); }),
                HasSubstr("must be positive"));
}

} // namespace
} // namespace toile::test
