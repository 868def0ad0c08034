#include "avatars/import/gltf_appearance.h"

#include <cmath>
#include <limits>
#include <map>
#include <new>

#include <Eigen/Geometry>

#include "avatars/import/gltf_clips.h"
#include "avatars/import/gltf_meshes.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

constexpr unsigned kColourTypes = kFloat | kUnsignedByte | kUnsignedShort;
/// KHR_mesh_quantization allows all but UNSIGNED_INT.
constexpr AccessorRule kCoordinates{"VEC2", kFloat | kByte | kUnsignedByte | kShort | kUnsignedShort};
constexpr AccessorRule kRgb{"VEC3", kColourTypes}, kRgba{"VEC4", kColourTypes};

constexpr double kDefaultCutoff = 0.5; ///< [-] alpha

std::optional<GltfValue> extension_of(const GltfValue& owner, const std::string& name)
{
    const std::optional<GltfValue> extensions = owner.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

Vec2 pair_or(const GltfValue& object, const std::string& key, const Vec2& otherwise)
{
    const std::optional<GltfValue> value = object.find(key);
    if (!value)
        return otherwise;
    const std::vector<double> numbers = value->numbers(2);
    return {numbers[0], numbers[1]};
}

double number_or(const GltfValue& object, const std::string& key, double otherwise)
{
    const std::optional<GltfValue> value = object.find(key);
    return value ? value->number() : otherwise;
}

/// Translation after rotation after scale of texture coordinates, whose v points down.
/// [KHR_texture_transform]
Eigen::Affine2d transform_of(const GltfValue& extension)
{
    return Eigen::Translation2d(pair_or(extension, "offset", Vec2::Zero())) *
           Eigen::Rotation2Dd(-number_or(extension, "rotation", 0.0)) *
           Eigen::Scaling(pair_or(extension, "scale", Vec2::Ones()));
}

Wrap wrap_of(const GltfValue& sampler, const std::string& key)
{
    constexpr int kRepeat = 10497, kClamp = 33071, kMirror = 33648;
    const std::optional<GltfValue> mode = sampler.find(key);
    if (!mode)
        return Wrap::Repeat;
    switch (mode->whole(0, std::numeric_limits<int>::max())) {
    case kRepeat:
        return Wrap::Repeat;
    case kClamp:
        return Wrap::Clamp;
    case kMirror:
        return Wrap::Mirror;
    default:
        mode->refuse("must be 33071, 33648 or 10497");
    }
}

/// Alpha below which nothing is there.
double cutoff_of(const GltfValue& material)
{
    const std::optional<GltfValue> mode = material.find("alphaMode");
    if (!mode || mode->text() == "OPAQUE")
        return 0.0;
    return mode->text() == "MASK" ? number_or(material, "alphaCutoff", kDefaultCutoff) : kDefaultCutoff;
}

class AppearanceReader {
public:
    AppearanceReader(GltfFile& file, GltfAccessors& accessors) : file_(file), accessors_(accessors) {}

    /// @param primitives  by ascending triangles
    /// @param added       the triangles that were finished
    Appearance read(const std::vector<PrimitiveFaces>& primitives, const std::vector<AddedTriangle>& added)
    {
        size_t t = 0;
        for (size_t p = 0; p < primitives.size(); ++p) {
            const Paint paint = paint_of(primitives[p]);
            const int end = p + 1 < primitives.size() ? primitives[p + 1].first_triangle
                                                      : std::numeric_limits<int>::max();
            for (; t < added.size() && added[t].index < end; ++t)
                add(paint, added[t].corners, primitives[p].first_vertex);
        }
        return std::move(appearance_);
    }

private:
    /// A material of the file, and what it needs of a primitive.
    struct Material {
        int index = -1;          ///< in the appearance; -1: it has no colour
        int coordinate_set = -1; ///< of its texture; -1: it has none
        Eigen::Affine2d transform = Eigen::Affine2d::Identity();
    };

    /// Colour of a primitive.
    struct Paint {
        Material material;
        Elements coordinates; ///< [vertices x 2] or empty
        Elements colours;     ///< [vertices x 3 or 4] or empty
    };

    void add(const Paint& paint, const Triangle& corners, int first_vertex)
    {
        CornerCoordinates& coordinates = appearance_.coordinates.emplace_back();
        CornerColours colours;
        for (size_t k = 0; k < 3; ++k) {
            const int v = corners[int(k)] - first_vertex;
            coordinates[k].setZero();
            if (paint.coordinates.count > 0)
                coordinates[k] =
                    paint.material.transform * Vec2(Eigen::Map<const Vec2>(paint.coordinates[v]));
            colours[k].setOnes();
            for (int channel = 0; channel < paint.colours.width; ++channel)
                colours[k][channel] = paint.colours[v][channel];
        }
        appearance_.material.push_back(paint.material.index);

        // Triangles of primitives without colours are white once others have some.
        if (paint.colours.count > 0)
            appearance_.colours.resize(appearance_.material.size() - 1, kWhite);
        if (paint.colours.count > 0 || !appearance_.colours.empty())
            appearance_.colours.push_back(colours);
    }

    Paint paint_of(const PrimitiveFaces& faces)
    {
        const GltfValue attributes = faces.primitive.at("attributes");
        Paint paint;
        if (const auto reference = faces.primitive.find("material"))
            paint.material = material(*reference);
        if (const int set = paint.material.coordinate_set; set >= 0) {
            const std::string key = "TEXCOORD_" + std::to_string(set);
            if (const auto reference = attributes.find(key)) {
                paint.coordinates = accessors_.read(*reference, kCoordinates, faces.vertex_count);
            } else {
                appearance_.left_out.push_back(attributes.place() + " has no " + key + " for its image");
                paint.material.index = without_texture(paint.material.index);
            }
        }
        if (const auto reference = attributes.find("COLOR_0")) {
            const GltfValue accessors = file_.list("accessors");
            const GltfValue type = accessors[reference->index(accessors.size(), "accessors")].at("type");
            paint.colours =
                accessors_.read(*reference, type.text() == kRgb.type ? kRgb : kRgba, faces.vertex_count);
            if (paint.material.index < 0)
                paint.material.index = appearance_.add_white();
        }
        return paint;
    }

    Material material(const GltfValue& reference)
    {
        const GltfValue materials = file_.list("materials");
        const int index = reference.index(materials.size(), "materials");
        const auto [known, is_new] = materials_.try_emplace(index);
        if (is_new)
            known->second = read_material(materials[index]);
        return known->second;
    }

    Material read_material(const GltfValue& value)
    {
        // Files of some years ago have only the extension.
        if (const auto old = extension_of(value, "KHR_materials_pbrSpecularGlossiness"))
            return read_material(value, *old, "diffuseFactor", "diffuseTexture");
        if (const auto base = value.find("pbrMetallicRoughness"))
            return read_material(value, *base, "baseColorFactor", "baseColorTexture");
        return {};
    }

    Material read_material(const GltfValue& value, const GltfValue& base, const std::string& factor_key,
                           const std::string& texture_key)
    {
        Material material;
        SurfaceMaterial surface;
        if (const auto factor = base.find(factor_key)) {
            const std::vector<double> rgba = factor->numbers(4);
            surface.colour = Vec3(rgba[0], rgba[1], rgba[2]);
            surface.alpha = rgba[3];
        }
        surface.cutoff = cutoff_of(value);
        if (const auto info = base.find(texture_key)) {
            surface.texture = texture(info->at("index"));
            std::optional<GltfValue> set = info->find("texCoord");
            if (const auto extension = extension_of(*info, "KHR_texture_transform")) {
                material.transform = transform_of(*extension);
                if (const auto other = extension->find("texCoord"))
                    set = other;
            }
            if (surface.texture)
                material.coordinate_set = set ? int(set->whole(0, kMaxSets)) : 0;
        }
        if (surface.colour || surface.texture) {
            material.index = int(appearance_.materials.size());
            appearance_.materials.push_back(surface);
        }
        return material;
    }

    std::optional<Texture> texture(const GltfValue& reference)
    {
        const GltfValue textures = file_.list("textures");
        const GltfValue value = textures[reference.index(textures.size(), "textures")];
        const std::optional<GltfValue> source = value.find("source");
        if (!source) {
            appearance_.left_out.push_back(value.place() + " names no PNG or JPEG image");
            return std::nullopt;
        }
        Texture texture;
        texture.image = image(*source);
        if (const auto index = value.find("sampler")) {
            const GltfValue samplers = file_.list("samplers");
            const GltfValue sampler = samplers[index->index(samplers.size(), "samplers")];
            texture.wrap = {wrap_of(sampler, "wrapS"), wrap_of(sampler, "wrapT")};
        }
        return texture;
    }

    int image(const GltfValue& reference)
    {
        const GltfValue images = file_.list("images");
        const int index = reference.index(images.size(), "images");
        const auto [known, is_new] = images_.try_emplace(index, int(appearance_.images.size()));
        if (is_new)
            appearance_.images.push_back({images[index].place(), content(images[index])});
        return known->second;
    }

    /// Bytes of an image; none if they can't be read, which is told.
    std::vector<unsigned char> content(const GltfValue& image)
    {
        try {
            if (const auto uri = image.find("uri")) {
                std::vector<unsigned char> bytes = file_.content_of(*uri);
                if (bytes.empty())
                    uri->refuse("is empty");
                return bytes;
            }
            const GltfValue views = file_.list("bufferViews");
            const Bytes bytes = file_.view(views[image.at("bufferView").index(views.size(), "bufferViews")]);
            return {bytes.begin(), bytes.end()};
        } catch (const InvalidInput& error) {
            appearance_.left_out.emplace_back(error.what());
            return {};
        }
    }

    /// The same material in its colour alone; -1 if it has none.
    int without_texture(int index)
    {
        SurfaceMaterial material = appearance_.materials[size_t(index)];
        if (!material.colour)
            return -1;
        material.texture.reset();
        appearance_.materials.push_back(material);
        return int(appearance_.materials.size()) - 1;
    }

    static constexpr int kMaxSets = 1000;
    inline static const CornerColours kWhite{Eigen::Vector4d::Ones(), Eigen::Vector4d::Ones(),
                                             Eigen::Vector4d::Ones()};

    GltfFile& file_;
    GltfAccessors& accessors_;
    Appearance appearance_;
    std::map<int, Material> materials_; ///< by their index in the file
    std::map<int, int> images_;         ///< likewise
};

} // namespace

Appearance import_gltf_appearance(const std::filesystem::path& file)
{
    try {
        GltfFile gltf(file);
        GltfAccessors accessors(gltf);
        ModelBuilder builder(file.string());
        const NodeTree tree = add_joints(gltf, builder.skeleton());
        const std::set<int> animated = nodes_with_moving_shapes(gltf);
        GltfMeshes meshes(gltf, accessors, tree, animated, builder);
        meshes.read();
        const RiggedModel model = builder.finish();
        Appearance appearance =
            AppearanceReader(gltf, accessors).read(meshes.primitives(), builder.added_triangles());
        appearance.triangles = model.mesh.rest.triangles;
        return appearance;
    } catch (const std::bad_alloc&) {
        throw InvalidInput(file.string() + ": needs more memory than there is; the file is too large");
    }
}

} // namespace toile::avatars
