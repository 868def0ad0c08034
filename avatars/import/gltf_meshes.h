#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "avatars/import/gltf_accessors.h"
#include "avatars/import/gltf_nodes.h"
#include "avatars/import/model_builder.h"

namespace toile::avatars {

/// Blend shapes of one node, among those of the model.
struct ShapeRange {
    int first = 0;
    int count = 0;
};

/// Triangles that a primitive adds to a model.
struct PrimitiveFaces {
    GltfValue primitive;
    int first_triangle = 0;
    int first_vertex = 0; ///< of vertex_count, which other primitives may share
    int vertex_count = 0;
};

/// Adds the meshes of all drawn nodes to a model.        [glTF 2.0, section 3.7]
class GltfMeshes {
public:
    /// @param tree            from add_joints(), for the builder's skeleton
    /// @param animated_nodes  nodes whose blend shapes move: these become shapes of the model. All others are
    ///                        applied to the positions at their default weights.
    GltfMeshes(GltfFile& file, GltfAccessors& accessors, const NodeTree& tree,
               const std::set<int>& animated_nodes, ModelBuilder& builder)
        : file_(file), accessors_(accessors), tree_(tree), animated_nodes_(animated_nodes), builder_(builder)
    {
    }

    /// @return blend shapes of every animated node that is drawn
    /// @throws InvalidInput naming the primitive, attribute or skin that is wrong.
    std::map<int, ShapeRange> read();

    /// What read() has added, by ascending triangles.
    const std::vector<PrimitiveFaces>& primitives() const { return primitives_; }

private:
    /// What the vertices of a node follow.
    struct Binding {
        std::vector<int> bones; ///< [joints of the skin], or the node's own bone
        int space = -1;         ///< see SkinnedMesh::space_of_vertex
        bool is_skinned = false;
        std::vector<double> weights; ///< [targets] of blend shapes
        int first_shape = -1;        ///< among the model's; -1: applied to the positions
    };

    /// Vertices of the model that a primitive added.
    struct VertexRange {
        int first = 0;
        int count = 0;
    };
    /// By the accessors that the vertices come from: primitives of a node share vertices.
    using KnownVertices = std::map<std::map<std::string, int>, VertexRange>;

    Binding bind(int node, const GltfValue& primitives);
    std::vector<double> default_weights(int node, int target_count) const;
    std::vector<Bone> bones_of_skin(const GltfValue& skin);
    void enter_space(const std::vector<Bone>& bones, Binding& binding);

    void add_primitive(const GltfValue& primitive, const Binding& binding, KnownVertices& known);
    std::map<std::string, int> sources_of(const GltfValue& primitive) const;
    std::vector<int> corners_of(const GltfValue& primitive, const VertexRange& vertices);
    VertexRange add_vertices(const GltfValue& primitive, const Binding& binding);
    void add_influences(const GltfValue& attributes, const Binding& binding, int vertex_count);
    void add_shapes(const GltfValue& targets, const Binding& binding, const VertexRange& vertices);

    GltfFile& file_;
    GltfAccessors& accessors_;
    const NodeTree& tree_;
    const std::set<int>& animated_nodes_;
    ModelBuilder& builder_;
    std::vector<PrimitiveFaces> primitives_;
    std::map<int, Binding> of_skin_; ///< what read() has met so far
    std::vector<int> space_of_bone_; ///< [bones of the model] -1: none yet
    int space_count_ = 0;
};

} // namespace toile::avatars
