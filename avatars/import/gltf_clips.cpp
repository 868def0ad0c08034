#include "avatars/import/gltf_clips.h"

#include <algorithm>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

constexpr AccessorRule kTimes{"SCALAR", kFloat};
constexpr unsigned kFractions = kFloat | kByte | kUnsignedByte | kShort | kUnsignedShort;
constexpr AccessorRule kVectors{"VEC3", kFractions};
constexpr AccessorRule kRotations{"VEC4", kFractions};
constexpr AccessorRule kShapeWeights{"SCALAR", kFractions};

constexpr const char* kTranslation = "translation";
constexpr const char* kRotation = "rotation";
constexpr const char* kScale = "scale";
constexpr const char* kWeights = "weights";

Interpolation interpolation_of(const GltfValue& sampler)
{
    const std::optional<GltfValue> value = sampler.find("interpolation");
    if (!value || value->text() == "LINEAR")
        return Interpolation::Linear;
    if (value->text() == "STEP")
        return Interpolation::Step;
    if (value->text() != "CUBICSPLINE")
        value->refuse("must be LINEAR, STEP or CUBICSPLINE");
    return Interpolation::CubicSpline;
}

void assign(const double* numbers, Vec3& value) { value = {numbers[0], numbers[1], numbers[2]}; }
void assign(const double* numbers, double& value) { value = *numbers; }
void assign(const double* numbers, Eigen::Quaterniond& value)
{
    value = {numbers[3], numbers[0], numbers[1], numbers[2]};
}

void normalise(Vec3&) {}
void normalise(double&) {}
void normalise(Eigen::Quaterniond& value) { value.normalize(); }

/// Keys of one sampler; its values are read once for all tracks that it drives.
class Sampler {
public:
    /// @param track_count  values per key: the blend shapes, or 1
    Sampler(GltfAccessors& accessors, const GltfValue& sampler, const AccessorRule& rule, int track_count)
        : place_(sampler.place()), interpolation_(interpolation_of(sampler)), track_count_(track_count),
          times_(accessors.read(sampler.at("input"), kTimes)),
          values_(accessors.read(sampler.at("output"), rule))
    {
        const std::int64_t needed = std::int64_t(times_.count) * track_count * parts();
        if (values_.count != needed)
            sampler.at("output").refuse("this accessor has " + std::to_string(values_.count) +
                                        " elements; the keys need " + std::to_string(needed));
        if (times_.values.front() < 0.0)
            sampler.at("input").refuse("key 0 is at " + std::to_string(times_.values.front()) +
                                       " s; times are 0 or more");
    }

    /// [s]
    double end() const { return times_.values.back(); }

    template <typename Value>
    Track<Value> track(int index) const
    {
        Track<Value> track;
        track.interpolation = interpolation_;
        track.keys.reserve(size_t(times_.count));
        for (int k = 0; k < times_.count; ++k) {
            // A key of a spline has the tangents of all tracks before their values, and after them.
            const int first = k * parts() * track_count_ + index;
            Key<Value>& key = track.keys.emplace_back();
            key.time = *times_[k];
            assign(values_[first + parts() / 2 * track_count_], key.value);
            if (interpolation_ == Interpolation::CubicSpline) {
                Tangents<Value>& tangents = track.tangents.emplace_back();
                assign(values_[first], tangents.in);
                assign(values_[first + 2 * track_count_], tangents.out);
            }
        }
        require_usable(track, place_);
        for (Key<Value>& key : track.keys)
            normalise(key.value);
        return track;
    }

private:
    int parts() const { return interpolation_ == Interpolation::CubicSpline ? 3 : 1; }

    std::string place_;
    Interpolation interpolation_;
    int track_count_;
    Elements times_, values_;
};

/// Builds one clip from the channels of an animation.
class ClipReader {
public:
    ClipReader(GltfAccessors& accessors, const NodeTree& tree,
               const std::map<int, ShapeRange>& shapes_of_node, std::string name)
        : accessors_(accessors), tree_(tree), shapes_of_node_(shapes_of_node), clip_{std::move(name)}
    {
    }

    Clip read(const GltfValue& animation)
    {
        const GltfValue channels = animation.at("channels"), samplers = animation.at("samplers");
        for (int i = 0; i < channels.size(); ++i) {
            const GltfValue target = channels[i].at("target");
            const GltfValue sampler = samplers[channels[i].at("sampler").index(samplers.size(), "samplers")];
            // A channel without a node belongs to an extension.
            if (target.find("node"))
                add_channel(target, sampler);
        }
        return std::move(clip_);
    }

private:
    void add_channel(const GltfValue& target, const GltfValue& sampler)
    {
        const int node = target.at("node").index(int(tree_.order.size()), "nodes");
        const GltfValue path = target.at("path");
        if (!moved_.emplace(node, path.text()).second)
            path.refuse("this animation moves it twice");
        if (path.text() == kWeights)
            add_shape_tracks(node, target, sampler);
        else if (path.text() == kRotation)
            track_of(node).rotation = read_track<Eigen::Quaterniond>(sampler, kRotations);
        else if (path.text() == kTranslation)
            track_of(node).translation = read_track<Vec3>(sampler, kVectors);
        else if (path.text() == kScale)
            track_of(node).scale = read_track<Vec3>(sampler, kVectors);
        else
            path.refuse("must be translation, rotation, scale or weights");
    }

    template <typename Value>
    Track<Value> read_track(const GltfValue& sampler, const AccessorRule& rule)
    {
        const Sampler keys(accessors_, sampler, rule, 1);
        clip_.duration = std::max(clip_.duration, keys.end());
        return keys.track<Value>(0);
    }

    void add_shape_tracks(int node, const GltfValue& target, const GltfValue& sampler)
    {
        const auto shapes = shapes_of_node_.find(node);
        if (shapes == shapes_of_node_.end()) {
            if (tree_.is_drawn[size_t(node)] != 0)
                target.at("node").refuse("this node has no mesh, so no weights move");
            return;
        }
        if (shapes->second.count == 0)
            target.at("node").refuse("the mesh of this node has no targets, so no weights move");
        const Sampler keys(accessors_, sampler, kShapeWeights, shapes->second.count);
        clip_.duration = std::max(clip_.duration, keys.end());
        for (int s = 0; s < shapes->second.count; ++s)
            clip_.shape_tracks.push_back({shapes->second.first + s, keys.track<double>(s)});
    }

    JointTrack& track_of(int node)
    {
        const auto [known, is_new] = track_of_node_.try_emplace(node, clip_.tracks.size());
        if (is_new)
            clip_.tracks.push_back({tree_.joint_of_node[size_t(node)]});
        return clip_.tracks[known->second];
    }

    GltfAccessors& accessors_;
    const NodeTree& tree_;
    const std::map<int, ShapeRange>& shapes_of_node_;
    Clip clip_;
    std::map<int, size_t> track_of_node_;
    std::set<std::pair<int, std::string>> moved_; ///< node and path
};

} // namespace

std::set<int> nodes_with_moving_shapes(const GltfFile& file)
{
    std::set<int> nodes;
    const GltfValue animations = file.list("animations");
    const int node_count = file.list("nodes").size();
    for (int a = 0; a < animations.size(); ++a) {
        const GltfValue channels = animations[a].at("channels");
        for (int c = 0; c < channels.size(); ++c) {
            const GltfValue target = channels[c].at("target");
            if (const std::optional<GltfValue> node = target.find("node"))
                if (target.at("path").text() == kWeights)
                    nodes.insert(node->index(node_count, "nodes"));
        }
    }
    return nodes;
}

void add_clips(GltfFile& file, GltfAccessors& accessors, const NodeTree& tree,
               const std::map<int, ShapeRange>& shapes_of_node, ModelBuilder& builder)
{
    const GltfValue animations = file.list("animations");
    std::vector<std::string> names;
    names.reserve(size_t(animations.size()));
    for (int a = 0; a < animations.size(); ++a)
        names.push_back(animations[a].name_or("clip_" + std::to_string(a)));
    names = distinct_names(std::move(names));
    for (int a = 0; a < animations.size(); ++a)
        builder.add_clip(ClipReader(accessors, tree, shapes_of_node, names[size_t(a)]).read(animations[a]));
}

} // namespace toile::avatars
