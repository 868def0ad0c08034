#include "avatars/landmarks/body_joints.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include <Eigen/Geometry>

namespace toile::avatars {

namespace {

/// Name of a joint without the parts in which programs differ.
struct JointName {
    std::string part;         ///< lower case, letters and digits: "forearm"
    std::optional<Side> side; ///< that it names
};

/// Words of a name: split at signs and where a capital follows a small letter or begins a word.
std::vector<std::string> words_of(const std::string& name)
{
    std::vector<std::string> words{""};
    for (size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        if (!std::isalnum(c)) {
            words.emplace_back();
            continue;
        }
        const bool after_small = i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]));
        const bool before_small =
            i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1]));
        if (std::isupper(c) && (after_small || before_small))
            words.emplace_back();
        words.back() += char(std::tolower(c));
    }
    std::erase(words, "");
    return words;
}

JointName parse(const std::string& name)
{
    JointName result;
    for (const std::string& word : words_of(name.substr(name.find_last_of(":|") + 1))) {
        if (word == "l" || word == "left")
            result.side = kLeft;
        else if (word == "r" || word == "right")
            result.side = kRight;
        else if (word.starts_with("left") || word.starts_with("right")) {
            result.side = word[0] == 'l' ? kLeft : kRight;
            result.part += word.substr(word[0] == 'l' ? 4 : 5);
        } else if (word != "mixamorig" && !word.starts_with("bip") && word != "j" && word != "def")
            result.part += word;
    }
    return result;
}

/// First joint of a side whose part has one of these names, earlier names first.
int find_part(const std::vector<JointName>& names, std::optional<Side> side,
              const std::vector<std::string>& parts)
{
    for (const std::string& part : parts)
        for (size_t j = 0; j < names.size(); ++j)
            if (names[j].part == part && names[j].side == side)
                return int(j);
    return -1;
}

/// A limb: the joints below the one at which it leaves the trunk, to one of its tips.
struct Chain {
    int parent = -1;
    std::vector<int> joints;
};

/// Part of the path to `tip` below the last joint of `trunk` on it.
Chain chain_below(const Skeleton& skeleton, int tip, const std::vector<int>& trunk)
{
    Chain chain;
    for (const int joint : path_from_root(skeleton, tip))
        if (std::find(trunk.begin(), trunk.end(), joint) != trunk.end())
            chain.parent = joint;
        else
            chain.joints.push_back(joint);
    return chain;
}

std::vector<int> tips_of(const Skeleton& skeleton)
{
    std::vector<char> has_child(size_t(skeleton.size()), 0);
    for (const Joint& joint : skeleton.joints())
        if (joint.parent >= 0)
            has_child[size_t(joint.parent)] = 1;
    std::vector<int> tips;
    for (int j = 0; j < skeleton.size(); ++j)
        if (!has_child[size_t(j)])
            tips.push_back(j);
    return tips;
}

/// Start, middle and end of a limb: of four joints and more before the first fork, the first is a collarbone.
BodyJoints::Limb limb_of(const Skeleton& skeleton, const std::vector<int>& chain, bool has_collarbone)
{
    std::vector<int> children(size_t(skeleton.size()), 0);
    for (const Joint& joint : skeleton.joints())
        if (joint.parent >= 0)
            ++children[size_t(joint.parent)];
    size_t whole = 0;
    while (whole < chain.size() && (whole == 0 || children[size_t(chain[whole - 1])] == 1))
        ++whole;
    const size_t first = has_collarbone && whole > 3 ? 1 : 0;
    if (chain.size() < first + 3)
        return {};
    return {chain[first], chain[first + 1], chain[first + 2]};
}

} // namespace

std::vector<int> path_from_root(const Skeleton& skeleton, int joint)
{
    std::vector<int> path;
    for (; joint >= 0; joint = skeleton.joints()[size_t(joint)].parent)
        path.push_back(joint);
    std::reverse(path.begin(), path.end());
    return path;
}

bool BodyJoints::is_whole() const { return missing().empty(); }

std::string BodyJoints::missing() const
{
    std::string text;
    const auto add = [&](bool is_there, const char* name) {
        if (!is_there)
            text += (text.empty() ? "" : ", ") + std::string(name);
    };
    add(arm[kLeft].is_whole(), "left arm");
    add(arm[kRight].is_whole(), "right arm");
    add(leg[kLeft].is_whole(), "left leg");
    add(leg[kRight].is_whole(), "right leg");
    add(neck >= 0, "neck");
    add(head >= 0, "head");
    return text;
}

BodyJoints joints_by_name(const Skeleton& skeleton)
{
    std::vector<JointName> names;
    for (const Joint& joint : skeleton.joints())
        names.push_back(parse(joint.name));
    BodyJoints joints;
    for (const Side side : {kLeft, kRight}) {
        joints.arm[side] = {find_part(names, side, {"upperarm", "arm", "uparm", "shoulder", "shldr"}),
                            find_part(names, side, {"forearm", "lowerarm", "elbow"}),
                            find_part(names, side, {"wrist", "hand"})};
        joints.leg[side] = {find_part(names, side, {"upleg", "thigh", "upperleg", "hip"}),
                            find_part(names, side, {"leg", "lowerleg", "shin", "calf", "knee"}),
                            find_part(names, side, {"ankle", "foot"})};
    }
    joints.neck = find_part(names, std::nullopt, {"neck", "neck01", "neck1", "neck0"});
    joints.head = find_part(names, std::nullopt, {"head"});
    return joints;
}

BodyJoints joints_by_tree(const Skeleton& skeleton, const std::vector<Vec3>& position)
{
    BodyJoints joints;
    std::vector<int> tips = tips_of(skeleton);
    if (tips.size() < 5)
        return joints;
    const auto y = [&](int j) { return position[size_t(j)].y(); };
    joints.head = *std::max_element(tips.begin(), tips.end(), [&](int a, int b) { return y(a) < y(b); });
    const std::vector<int> spine = path_from_root(skeleton, joints.head);
    joints.neck = spine.size() > 1 ? spine[spine.size() - 2] : -1;

    // The longest chain of each branch off the spine.
    std::vector<Chain> limbs;
    for (const int tip : tips) {
        Chain chain = chain_below(skeleton, tip, spine);
        if (chain.joints.size() < 3)
            continue;
        const auto same = std::find_if(limbs.begin(), limbs.end(), [&](const Chain& other) {
            return other.joints.front() == chain.joints.front();
        });
        if (same == limbs.end())
            limbs.push_back(std::move(chain));
        else if (same->joints.size() < chain.joints.size())
            *same = std::move(chain);
    }
    if (limbs.size() != 4)
        return joints;
    std::stable_sort(limbs.begin(), limbs.end(),
                     [&](const Chain& a, const Chain& b) { return y(a.joints.back()) < y(b.joints.back()); });

    // Left is where the toes say.
    Vec3 front = Vec3::Zero();
    for (int k = 0; k < 2; ++k) {
        const std::vector<int>& leg = limbs[size_t(k)].joints;
        front += position[size_t(leg.back())] - position[size_t(leg[2])];
    }
    const Vec3 left = Vec3::UnitY().cross(front);
    for (const size_t pair : {0u, 2u}) {
        Chain &a = limbs[pair], &b = limbs[pair + 1];
        if (left.dot(position[size_t(a.joints[1])] - position[size_t(b.joints[1])]) < 0.0)
            std::swap(a, b);
        auto& limb = pair == 0 ? joints.leg : joints.arm;
        limb[kLeft] = limb_of(skeleton, a.joints, pair != 0);
        limb[kRight] = limb_of(skeleton, b.joints, pair != 0);
    }
    return joints;
}

std::vector<char> subtree(const Skeleton& skeleton, int root)
{
    std::vector<char> below(size_t(skeleton.size()), 0);
    for (int j = 0; j < skeleton.size(); ++j) {
        const int parent = skeleton.joints()[size_t(j)].parent;
        below[size_t(j)] = j == root || (parent >= 0 && below[size_t(parent)]);
    }
    return below;
}

} // namespace toile::avatars
