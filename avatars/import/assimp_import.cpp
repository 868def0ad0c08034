#include "avatars/import/assimp_import.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <optional>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "avatars/import/model_builder.h"
#include "core/base/child_process.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

Vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Eigen::Quaterniond to_quaternion(const aiQuaternion& q)
{
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

Affine to_affine(const aiMatrix4x4& m)
{
    Affine result;
    result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
    return result;
}

/// Textures that colour a surface, the preferred one first.
constexpr std::array kColourTextures{aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};

/// Builds a RiggedModel from one assimp scene.
class SceneReader {
public:
    SceneReader(const aiScene& scene, const std::string& source)
        : scene_(scene), source_(source), builder_(source)
    {
    }

    RiggedModel read()
    {
        read_parts();
        return builder_.finish();
    }

    SkeletalMotion read_motion()
    {
        read_parts();
        return builder_.motion();
    }

    Appearance read_appearance()
    {
        read_parts();
        Appearance appearance;
        appearance.triangles = builder_.finish().mesh.rest.triangles;
        add_materials(appearance);
        const int white = appearance.add_white();
        for (const AddedTriangle& triangle : builder_.added_triangles())
            add_corners(triangle, white, appearance);
        return appearance;
    }

private:
    void read_parts()
    {
        add_node(*scene_.mRootNode, -1);
        for (const auto& [mesh, joint] : instances_)
            add_mesh(*scene_.mMeshes[mesh], joint);
        add_clips();
    }

    void add_node(const aiNode& node, int parent)
    {
        aiVector3D scale, translation;
        aiQuaternion rotation;
        node.mTransformation.Decompose(scale, rotation, translation);
        const int joint = builder_.skeleton().add(
            {node.mName.C_Str(), parent, {to_vec3(translation), to_quaternion(rotation), to_vec3(scale)}});
        for (unsigned i = 0; i < node.mNumMeshes; ++i)
            instances_.emplace_back(node.mMeshes[i], joint);
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            add_node(*node.mChildren[i], joint);
    }

    /// Appends a mesh. Skinned meshes share space 0; a rigid mesh has a space for its node.
    void add_mesh(const aiMesh& mesh, int node_joint)
    {
        SkinnedMesh& out = builder_.mesh();
        const int first_vertex = out.rest.vertex_count();
        mesh_from_.insert_or_assign(first_vertex, &mesh); // the last, if those before have no vertices
        for (unsigned v = 0; v < mesh.mNumVertices; ++v)
            out.rest.positions.push_back(to_vec3(mesh.mVertices[v]));
        out.space_of_vertex.resize(out.rest.positions.size(), mesh.HasBones() ? 0 : node_joint + 1);
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices == 3)
                out.rest.triangles.emplace_back(first_vertex + int(face.mIndices[0]),
                                                first_vertex + int(face.mIndices[1]),
                                                first_vertex + int(face.mIndices[2]));
        }

        std::vector<std::vector<Influence>> influences(mesh.mNumVertices);
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            const int index =
                builder_.add_bone({builder_.skeleton().require(bone.mName.C_Str(), source_ + ": a mesh"),
                                   to_affine(bone.mOffsetMatrix)});
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                const aiVertexWeight& part = bone.mWeights[w];
                if (part.mVertexId >= mesh.mNumVertices)
                    throw InvalidInput(source_ + ": bone '" + bone.mName.C_Str() + "' weighs vertex " +
                                       std::to_string(part.mVertexId) + " of " +
                                       std::to_string(mesh.mNumVertices));
                influences[part.mVertexId].push_back({index, part.mWeight});
            }
        }
        if (!mesh.HasBones()) {
            const int index = builder_.add_bone({node_joint, identity_affine()});
            std::fill(influences.begin(), influences.end(), std::vector<Influence>{{index, 1.0}});
        }
        for (const std::vector<Influence>& parts : influences) {
            out.influences.insert(out.influences.end(), parts.begin(), parts.end());
            out.first.push_back(int(out.influences.size()));
        }
    }

    void add_clips()
    {
        std::vector<std::string> names;
        for (unsigned i = 0; i < scene_.mNumAnimations; ++i) {
            const aiString& name = scene_.mAnimations[i]->mName;
            names.push_back(name.length > 0 ? name.C_Str() : "clip_" + std::to_string(i));
        }
        names = distinct_names(std::move(names));
        for (unsigned i = 0; i < scene_.mNumAnimations; ++i)
            add_clip(*scene_.mAnimations[i], names[i]);
    }

    void add_clip(const aiAnimation& animation, const std::string& name)
    {
        const double ticks_per_second = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 1.0;
        Clip clip;
        clip.name = name;
        for (unsigned c = 0; c < animation.mNumChannels; ++c) {
            const aiNodeAnim& channel = *animation.mChannels[c];
            JointTrack track;
            track.joint = builder_.skeleton().require(channel.mNodeName.C_Str(),
                                                      source_ + ": clip '" + clip.name + "'");
            for (unsigned k = 0; k < channel.mNumPositionKeys; ++k)
                track.translation.keys.push_back({channel.mPositionKeys[k].mTime / ticks_per_second,
                                                  to_vec3(channel.mPositionKeys[k].mValue)});
            for (unsigned k = 0; k < channel.mNumRotationKeys; ++k)
                track.rotation.keys.push_back({channel.mRotationKeys[k].mTime / ticks_per_second,
                                               to_quaternion(channel.mRotationKeys[k].mValue)});
            for (unsigned k = 0; k < channel.mNumScalingKeys; ++k)
                track.scale.keys.push_back({channel.mScalingKeys[k].mTime / ticks_per_second,
                                            to_vec3(channel.mScalingKeys[k].mValue)});
            const std::string place =
                source_ + ": clip '" + name + "': joint '" + channel.mNodeName.C_Str() + "': ";
            require_usable(track.translation, place + "translation");
            require_usable(track.rotation, place + "rotation");
            require_usable(track.scale, place + "scale");
            clip.tracks.push_back(std::move(track));
        }
        clip.duration = animation.mDuration / ticks_per_second;
        builder_.add_clip(std::move(clip));
    }

    /// All materials of the scene: material i of a mesh is appearance.materials[i].
    void add_materials(Appearance& appearance) const
    {
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            const aiMaterial& from = *scene_.mMaterials[i];
            SurfaceMaterial& material = appearance.materials.emplace_back();
            aiColor4D colour;
            const bool is_invented = from.GetName() == aiString(AI_DEFAULT_MATERIAL_NAME);
            if (!is_invented && (from.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
                                 from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS))
                material.colour = Vec3(colour.r, colour.g, colour.b);
            for (const aiTextureType type : kColourTextures)
                if (!material.texture)
                    material.texture = texture(from, type, appearance);
            if (material.texture)
                material.colour.reset(); // FBX has the image in place of the colour
        }
    }

    std::optional<Texture> texture(const aiMaterial& material, aiTextureType type,
                                   Appearance& appearance) const
    {
        aiString name;
        std::array<aiTextureMapMode, 2> modes{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        if (material.GetTexture(type, 0, &name, nullptr, nullptr, nullptr, nullptr, modes.data()) !=
            aiReturn_SUCCESS)
            return std::nullopt;
        Texture texture;
        for (size_t k = 0; k < 2; ++k)
            texture.wrap[k] = modes[k] == aiTextureMapMode_Mirror ? Wrap::Mirror
                              : modes[k] == aiTextureMapMode_Wrap ? Wrap::Repeat
                                                                  : Wrap::Clamp;
        const std::string place = source_ + ": material '" + material.GetName().C_Str() + "'";
        const aiTexture* embedded = scene_.GetEmbeddedTexture(name.C_Str());
        if (embedded == nullptr) {
            texture.image = appearance.add_image_file(source_, name.C_Str(), place);
            return texture;
        }
        texture.image = int(appearance.images.size());
        StoredImage& image = appearance.images.emplace_back(StoredImage{place, {}});
        const auto* bytes = reinterpret_cast<const unsigned char*>(embedded->pcData);
        const bool is_file = embedded->mHeight == 0; // else its texels
        if (is_file && bytes != nullptr)
            image.bytes.assign(bytes, bytes + embedded->mWidth);
        if (image.bytes.empty())
            appearance.left_out.push_back(place + ": its image is neither PNG nor JPEG");
        return texture;
    }

    /// @param white  material under colours of vertices that have no other
    void add_corners(const AddedTriangle& triangle, int white, Appearance& appearance) const
    {
        const auto [first_vertex, mesh] = *std::prev(mesh_from_.upper_bound(triangle.corners[0]));
        const int index = mesh->mMaterialIndex < scene_.mNumMaterials ? int(mesh->mMaterialIndex) : -1;
        const SurfaceMaterial material = index < 0 ? SurfaceMaterial{} : appearance.materials[size_t(index)];
        // Colours of vertices under a texture are masks of other programs.
        const bool has_colours = mesh->HasVertexColors(0) && !material.texture;
        CornerCoordinates coordinates;
        CornerColours colours;
        for (size_t k = 0; k < 3; ++k) {
            const int v = triangle.corners[int(k)] - first_vertex;
            coordinates[k].setZero();
            if (mesh->HasTextureCoords(0)) // v of assimp points up
                coordinates[k] = Vec2(mesh->mTextureCoords[0][v].x, 1.0 - mesh->mTextureCoords[0][v].y);
            colours[k].setOnes();
            if (has_colours) {
                const aiColor4D& colour = mesh->mColors[0][v];
                colours[k] = Eigen::Vector4d(colour.r, colour.g, colour.b, colour.a);
            }
        }
        appearance.material.push_back(has_colours && !material.colour ? white : index);
        appearance.coordinates.push_back(coordinates);
        appearance.colours.push_back(colours);
    }

    const aiScene& scene_;
    std::string source_;
    ModelBuilder builder_;
    std::map<int, const aiMesh*> mesh_from_;          ///< by first vertex
    std::vector<std::pair<unsigned, int>> instances_; ///< mesh index, joint of its node
};

/// Name of assimp's own format, which keeps every number.
constexpr const char* kOwnFormat = "assbin";

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason)
{
    throw InvalidInput(file.string() + ": can't be read as a model (" + reason + ")");
}

[[noreturn]] void refuse(const std::filesystem::path& file, const Assimp::Importer& importer)
{
    try {
        if (importer.GetException())
            std::rethrow_exception(importer.GetException());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) { // assimp's own, which GetErrorString() tells
    }
    std::string reason = importer.GetErrorString();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    refuse(file, reason);
}

/// Bounds that whole files stay far below: 10 MB are read within a second, in a tenth of the memory.
ChildBounds bounds_for(const std::filesystem::path& file)
{
    const std::uintmax_t megabytes = std::filesystem::file_size(file) >> 20;
    return {std::chrono::seconds(20 + 2 * megabytes), (1000 + 100 * megabytes) << 20};
}

enum class Images { Keep, LeaveOut };

/// Lets materials name the images in their file by number: assimp's own format keeps no other name of them.
void number_images(aiScene& scene)
{
    for (unsigned i = 0; i < scene.mNumMaterials; ++i)
        for (const aiTextureType type : kColourTextures) {
            aiMaterial& material = *scene.mMaterials[i];
            aiString name;
            if (material.GetTexture(type, 0, &name) != aiReturn_SUCCESS)
                continue;
            if (const int number = scene.GetEmbeddedTextureAndIndex(name.C_Str()).second; number >= 0) {
                name = "*";
                name.Append(std::to_string(number).c_str());
                material.AddProperty(&name, AI_MATKEY_TEXTURE(type, 0));
            }
        }
}

/// Content of a file in assimp's own format.
std::string in_own_format(const std::filesystem::path& file, Images images)
{
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    // Pivots as extra nodes would tip an FBX body onto its side once a motion file without them drives it.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType;
    if (images == Images::LeaveOut) {
        importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_TEXTURES);
        steps |= aiProcess_RemoveComponent;
    }
    const aiScene* read = importer.ReadFile(file.string(), steps);
    if (!read || !read->mRootNode)
        refuse(file, importer);
    const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene()); // forgets what was wrong
    number_images(*scene);
    Assimp::Exporter exporter;
    const aiExportDataBlob* content = exporter.ExportToBlob(scene.get(), kOwnFormat);
    if (!content)
        refuse(file, exporter.GetErrorString());
    return {static_cast<const char*>(content->data), content->size};
}

/// Reads the file in a child process: assimp's readers crash, loop and fill the memory for some damaged
/// files.
/// @param importer  owns the result
const aiScene* read_scene(Assimp::Importer& importer, const std::filesystem::path& file,
                          Images images = Images::LeaveOut)
{
    std::string content;
    try {
        content = in_child_process([&] { return in_own_format(file, images); }, bounds_for(file));
    } catch (const ChildStopped& stop) {
        throw InvalidInput(file.string() + ": can't be read: assimp's reader " + stop.what() +
                           "; export the model again, best as .glb");
    }
    const aiScene* scene = importer.ReadFileFromMemory(content.data(), content.size(), 0, kOwnFormat);
    if (!scene)
        refuse(file, importer);
    return scene;
}

} // namespace

RiggedModel import_rigged_model(const std::filesystem::path& file)
{
    Assimp::Importer importer;
    const aiScene* scene = read_scene(importer, file);
    return SceneReader(*scene, file.string()).read();
}

Appearance import_model_appearance(const std::filesystem::path& file)
{
    Assimp::Importer importer;
    const aiScene* scene = read_scene(importer, file, Images::Keep);
    return SceneReader(*scene, file.string()).read_appearance();
}

SkeletalMotion import_skeletal_motion(const std::filesystem::path& file)
{
    Assimp::Importer importer;
    const aiScene* scene = read_scene(importer, file);
    return SceneReader(*scene, file.string()).read_motion();
}

} // namespace toile::avatars
