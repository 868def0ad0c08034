#include "avatars/import/gltf_nodes.h"

#include "avatars/import/model_builder.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

/// Deviation from right angles between the columns of a matrix up to which they are a rotation [-]. Files in
/// single precision stay below a hundredth of it.
constexpr double kMaxShear = 1e-3;

/// Deviation of a matrix's fourth row from 0, 0, 0, 1 that counts as rounding [-].
constexpr double kMaxRowError = 1e-5;

/// Parent of every node, -1 for roots. [nodes]
std::vector<int> parents_of(const GltfValue& nodes)
{
    std::vector<int> parents(size_t(nodes.size()), -1);
    for (int i = 0; i < nodes.size(); ++i) {
        const GltfValue children = nodes[i].list("children");
        for (int k = 0; k < children.size(); ++k) {
            int& parent = parents[size_t(children[k].index(nodes.size(), "nodes"))];
            if (parent >= 0)
                children[k].refuse("this node is already a child of nodes[" + std::to_string(parent) +
                                   "]; a node has one parent");
            parent = i;
        }
    }
    return parents;
}

/// Roots of the scene that the file shows: its own choice, else the first.
std::vector<int> roots_of_scene(const GltfFile& file, const std::vector<int>& parents)
{
    const GltfValue scenes = file.list("scenes");
    const std::optional<GltfValue> chosen = file.root().find("scene");
    const GltfValue roots = scenes[chosen ? chosen->index(scenes.size(), "scenes") : 0].list("nodes");
    std::vector<int> result;
    for (int i = 0; i < roots.size(); ++i) {
        const int node = roots[i].index(int(parents.size()), "nodes");
        if (const int parent = parents[size_t(node)]; parent >= 0)
            roots[i].refuse("this node is a child of nodes[" + std::to_string(parent) +
                            "]; a scene lists roots");
        result.push_back(node);
    }
    return result;
}

/// Rotation whose columns are those of A, each of its length in `scale`; columns of length 0 are replaced.
Mat3 rotation_of(const Mat3& A, const Vec3& scale)
{
    Mat3 R = Mat3::Identity();
    int known = 0, last = 0;
    for (int k = 0; k < 3; ++k)
        if (scale[k] != 0.0) {
            R.col(k) = A.col(k) / scale[k];
            ++known;
            last = k;
        }
    if (known == 1)
        return Eigen::Quaterniond::FromTwoVectors(Vec3::Unit(last), R.col(last)).toRotationMatrix();
    for (int k = 0; known == 2 && k < 3; ++k)
        if (scale[k] == 0.0)
            R.col(k) = R.col((k + 1) % 3).cross(R.col((k + 2) % 3));
    return R;
}

JointTransform decompose(const GltfValue& matrix)
{
    const Affine M = affine_of(matrix.numbers(16).data(), matrix);
    const Mat3 A = M.leftCols<3>();
    Vec3 scale = A.colwise().stableNorm().transpose();
    if (A.determinant() < 0.0)
        scale.x() = -scale.x();
    const Mat3 R = rotation_of(A, scale);
    if (!((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < kMaxShear))
        matrix.refuse("it must be a translation, rotation and scale; this one shears");
    return {M.col(3), Eigen::Quaterniond(R).normalized(), scale};
}

JointTransform rest_of(const GltfValue& node)
{
    if (const std::optional<GltfValue> matrix = node.find("matrix"))
        return decompose(*matrix);
    JointTransform rest;
    if (const std::optional<GltfValue> translation = node.find("translation"))
        rest.translation = Eigen::Map<const Vec3>(translation->numbers(3).data());
    if (const std::optional<GltfValue> scale = node.find("scale"))
        rest.scale = Eigen::Map<const Vec3>(scale->numbers(3).data());
    if (const std::optional<GltfValue> rotation = node.find("rotation")) {
        const Eigen::Quaterniond q(Eigen::Map<const Eigen::Vector4d>(rotation->numbers(4).data()));
        if (!(q.coeffs().stableNorm() > 0.0))
            rotation->refuse("a rotation is a quaternion of length 1");
        rest.rotation = Eigen::Quaterniond(q.coeffs().stableNormalized());
    }
    return rest;
}

/// Nodes below these roots, depth first, parents before children.
std::vector<int> depth_first(const GltfValue& nodes, const std::vector<int>& roots)
{
    std::vector<int> order;
    std::vector<int> open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        order.push_back(node);
        const GltfValue children = nodes[node].list("children");
        for (int k = children.size(); k-- > 0;)
            open.push_back(children[k].index(nodes.size(), "nodes"));
    }
    return order;
}

std::vector<std::string> names_of(const GltfValue& nodes)
{
    std::vector<std::string> names;
    names.reserve(size_t(nodes.size()));
    for (int i = 0; i < nodes.size(); ++i)
        names.push_back(nodes[i].name_or("nodes_" + std::to_string(i)));
    return distinct_names(std::move(names));
}

/// Order and visibility of the nodes; joints are still unset.
NodeTree tree_of(const GltfFile& file, const std::vector<int>& parents)
{
    const GltfValue nodes = file.list("nodes");
    NodeTree tree;
    const bool has_scene = file.list("scenes").size() > 0 || file.root().find("scene");
    tree.is_drawn.resize(parents.size(), has_scene ? 0 : 1);
    if (has_scene)
        tree.order = depth_first(nodes, roots_of_scene(file, parents));
    std::vector<char> is_reached(parents.size(), 0);
    for (const int node : tree.order) {
        if (tree.is_drawn[size_t(node)] != 0)
            nodes[node].refuse("a scene lists every root once");
        tree.is_drawn[size_t(node)] = is_reached[size_t(node)] = 1;
    }

    std::vector<int> other_roots;
    for (size_t i = 0; i < parents.size(); ++i)
        if (parents[i] < 0 && is_reached[i] == 0)
            other_roots.push_back(int(i));
    const std::vector<int> others = depth_first(nodes, other_roots);
    tree.order.insert(tree.order.end(), others.begin(), others.end());
    for (const int node : others)
        is_reached[size_t(node)] = 1;
    for (size_t i = 0; i < parents.size(); ++i)
        if (is_reached[i] == 0)
            nodes[int(i)].refuse("this node is below itself; nodes must form trees");
    return tree;
}

} // namespace

Affine affine_of(const double* columns, const GltfValue& place)
{
    const Eigen::Map<const Eigen::Matrix4d> matrix(columns); // by columns too
    if (!((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kMaxRowError))
        place.refuse("the fourth row of a matrix must be 0, 0, 0, 1");
    return matrix.topRows<3>();
}

NodeTree add_joints(const GltfFile& file, Skeleton& skeleton)
{
    const GltfValue nodes = file.list("nodes");
    const std::vector<int> parents = parents_of(nodes);
    NodeTree tree = tree_of(file, parents);
    const std::vector<std::string> names = names_of(nodes);
    tree.joint_of_node.resize(parents.size(), -1);
    for (const int node : tree.order) {
        const int parent = parents[size_t(node)];
        tree.joint_of_node[size_t(node)] =
            skeleton.add({names[size_t(node)], parent < 0 ? -1 : tree.joint_of_node[size_t(parent)],
                          rest_of(nodes[node])});
    }
    return tree;
}

} // namespace toile::avatars
