#include <gmock/gmock.h>

#include <cstring>

#include <nlohmann/json.hpp>

#include "apps/preview/image.h"
#include "tests/apps/preview/encoded_image.h"
#include "tests/apps/program.h"
#include "tests/avatars/gltf_sample.h"

/// toile render: avatars in the colours and images of their files.
namespace toile::test {

namespace {

using preview::Image;
using testing::HasSubstr;
using testing::Not;

const std::array<Rgba, 4> kFour{kRed, kGreen, kBlue, kYellow};

/// A square of side 2 that faces +Z, with an image on all of it.
GltfSample textured_square()
{
    GltfSample sample = GltfSample::triangle();
    sample.json["meshes"] = {
        {{"primitives",
          {{{"attributes",
             {{"POSITION", sample.add<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")},
              {"TEXCOORD_0", sample.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2")}}},
            {"indices", sample.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR")},
            {"material", 0}}}}}};
    sample.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    sample.json["textures"] = {{{"source", 0}}};
    return sample;
}

std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// A binary file whose only chunk of data holds an image.
std::string glb(GltfSample sample, const Bytes& image)
{
    // Buffer 0 becomes that of the chunk.
    for (nlohmann::json& view : sample.json["bufferViews"])
        view["buffer"] = view["buffer"].get<int>() + 1;
    sample.json["buffers"].insert(sample.json["buffers"].begin(),
                                  nlohmann::json{{"byteLength", image.size()}});
    sample.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", image.size()}});
    sample.json["images"] = {
        {{"bufferView", sample.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
    std::string json = sample.json.dump(), binary = text_of(image);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto number = [](size_t value) {
        std::string bytes(4, '\0');
        const auto small = std::uint32_t(value);
        std::memcpy(bytes.data(), &small, 4);
        return bytes;
    };
    return "glTF" + number(2) + number(28 + json.size() + binary.size()) + number(json.size()) + "JSON" +
           json + number(binary.size()) + std::string("BIN\0", 4) + binary;
}

class TexturedAvatar : public FileTest {
protected:
    /// Writes a scene with a body that is seen from its front.
    void write_scene(const std::string& body) const
    {
        temporary_.write("scene.json",
                         R"({"toile": 1, "frames": 1, "gravity": [0, 0, 0],
                             "avatars": [{"name": "body", "file": ")" +
                             body + R"(", "color": [0.8, 0.4, 0.2]}],
                             "cloths": [{"name": "rag", "rectangle": {"size": [0.1, 0.1], "resolution": 0.05},
                                         "translate": [0, 0, -1], "fabric": "cotton"}],
                             "render": {"width": 96, "height": 96, "samples": 4, "ground": "off",
                                        "azimuth_deg": 0, "elevation_deg": 0}})");
    }

    Finished render(std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(), {"render", "scene.json", "--quiet", "--target", "body", "-o", "a.png"});
        return run_toile(more, folder_);
    }

    Image picture(const std::vector<std::string>& more = {}) const
    {
        const Finished finished = render(more);
        EXPECT_EQ(finished.exit_code, 0) << finished.errors;
        EXPECT_EQ(finished.errors, "");
        return shown();
    }

    Image shown() const
    {
        png_image read{};
        read.version = PNG_IMAGE_VERSION;
        if (!png_image_begin_read_from_file(&read, file("a.png").c_str()))
            return {};
        read.format = PNG_FORMAT_RGB;
        Image image(int(read.width), int(read.height));
        png_image_finish_read(&read, nullptr, image.rgb.data(), 0, nullptr);
        return image;
    }

    /// Expects four colours in the quarters of the square.
    static void expect_upright(const Image& image)
    {
        const auto differs = [&](int x, int y, size_t high, size_t low) {
            return int(image.pixel(x, y)[high]) - int(image.pixel(x, y)[low]);
        };
        EXPECT_GT(differs(26, 26, 0, 1), 60); // red
        EXPECT_GT(differs(70, 26, 1, 0), 60); // green
        EXPECT_GT(differs(26, 70, 2, 0), 60); // blue
        EXPECT_GT(differs(70, 70, 1, 2), 60); // yellow
        EXPECT_GT(differs(70, 70, 0, 2), 60);
    }

    static int largest_difference(const Image& a, const Image& b)
    {
        int largest = a.rgb.size() == b.rgb.size() ? 0 : 255;
        for (size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i)
            largest = std::max(largest, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
        return largest;
    }
};

} // namespace

TEST_F(TexturedAvatar, ShowsImagesUprightFromWhereverTheyAre)
{
    const preview::DecodedImage image = quarters(kFour, 16);
    temporary_.write("body.glb", glb(textured_square(), png_of(image)));
    write_scene("body.glb");
    expect_upright(picture());

    GltfSample sample = textured_square();
    sample.json["images"] = {{{"uri", "data:image/jpeg;base64," + GltfSample::base64(jpeg_of(image))}}};
    temporary_.write("body.gltf", sample.json.dump());
    write_scene("body.gltf");
    expect_upright(picture());

    temporary_.write("my skin.png", text_of(png_of(image)));
    sample.json["images"] = {{{"uri", "my%20skin.png"}}};
    temporary_.write("body.gltf", sample.json.dump());
    expect_upright(picture());

    temporary_.write("body.mtl", "newmtl skin\nmap_Kd my skin.png\n");
    temporary_.write("body.obj", "mtllib body.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                                 "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3 4/4\n");
    write_scene("body.obj");
    expect_upright(picture());
}

TEST_F(TexturedAvatar, ShowsAnImageOfOneColourLikeThatColour)
{
    // The color of the scene, in bytes of sRGB.
    const Rgba colour{204, 102, 51, 255};
    temporary_.write("body.glb",
                     glb(textured_square(), png_of(quarters({colour, colour, colour, colour}, 2))));
    write_scene("body.glb");
    const Image textured = picture(), plain = picture({"--no-textures"});
    EXPECT_LE(largest_difference(textured, plain), 1);
}

TEST_F(TexturedAvatar, LeavesTexturesOutOnRequest)
{
    temporary_.write("body.glb", glb(textured_square(), png_of(quarters(kFour, 16))));
    write_scene("body.glb");
    const Image plain = picture({"--no-textures"});
    EXPECT_GT(largest_difference(plain, picture()), 60);
    GltfSample bare = textured_square();
    bare.json.erase("materials");
    bare.at("/meshes/0/primitives/0").erase("material");
    temporary_.write("body.glb", glb(bare, png_of(quarters(kFour, 16))));
    EXPECT_EQ(largest_difference(plain, picture()), 0);
}

TEST_F(TexturedAvatar, IsDrawnInItsColorWithOneWarningForABrokenImage)
{
    Bytes broken = png_of(quarters(kFour, 40));
    broken.resize(broken.size() / 2);
    temporary_.write("body.glb", glb(textured_square(), broken));
    write_scene("body.glb");
    const Image plain = picture({"--no-textures"});
    const Finished finished = render();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_EQ(std::count(finished.errors.begin(), finished.errors.end(), '\n'), 1) << finished.errors;
    EXPECT_THAT(finished.errors,
                HasSubstr("warning: body.glb: images[0]: can't be read as PNG: it is cut off; "
                          "avatar \"body\" is drawn without it"));
    EXPECT_EQ(largest_difference(plain, shown()), 0);

    GltfSample missing = textured_square();
    missing.json["images"] = {{{"uri", "lost.png"}}};
    temporary_.write("body.gltf", missing.json.dump());
    write_scene("body.gltf");
    EXPECT_THAT(render().errors, HasSubstr("images[0].uri = \"lost.png\": no such file beside this one"));
    EXPECT_EQ(largest_difference(plain, shown()), 0);

    missing.at("/materials/0/pbrMetallicRoughness/baseColorTexture/index") = 3;
    temporary_.write("body.gltf", missing.json.dump());
    EXPECT_THAT(render().errors,
                HasSubstr("index 3 is out of bounds of 1 textures; avatar \"body\" is drawn in "
                          "its color"));
    EXPECT_EQ(largest_difference(plain, shown()), 0);
}

TEST_F(TexturedAvatar, IsSimulatedWithoutItsImages)
{
    GltfSample sample = textured_square();
    sample.json["images"] = {{{"uri", "lost.png"}}};
    temporary_.write("body.gltf", sample.json.dump());
    write_scene("body.gltf");
    const Finished finished = run_toile({"simulate", "scene.json", "-o", "out", "--quiet"}, folder_);
    EXPECT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_THAT(finished.errors, Not(HasSubstr("lost.png")));
}

TEST_F(TexturedAvatar, NeverLosesItsImageToThePicture)
{
    temporary_.write("a.png", text_of(png_of(quarters(kFour, 16))));
    temporary_.write("body.mtl", "newmtl skin\nmap_Kd a.png\n");
    temporary_.write("body.obj", "mtllib body.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                                 "usemtl skin\nf 1/1 2/2 3/3\n");
    write_scene("body.obj");
    const auto before = temporary_.snapshot();
    const Finished finished = render();
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.errors, HasSubstr("a.png"));
    EXPECT_EQ(temporary_.snapshot(), before);
}

} // namespace toile::test
