#include "export/alembic/abc_reader.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/number.h"
#include "export/byte_order.h"
#include "export/times/frame_times.h"

namespace toile::exports {

namespace {

/// Objects above each other, and objects of an archive, at most.
constexpr int kMaxDepth = 100, kMaxObjects = 100000;

/// Characters of a name, at most.
constexpr std::uint32_t kMaxName = 4096;

/// Samples of a property, at most: ten hours at 24 per second and 100 subframes fit.
constexpr std::uint32_t kMaxSamples = 1u << 27;

constexpr std::uint32_t kInlineMetadata = 0xff;
constexpr size_t kDigest = 16, kHashes = 32;

/// Reads a list of headers from its begin to its end.
class Headers {
public:
    Headers(const OgawaReader& file, OgawaNode node) : file_(file), node_(node), bytes_(file.data(node)) {}

    void leave_out_at_end(size_t count) { bytes_.resize(bytes_.size() - std::min(count, bytes_.size())); }
    bool is_at_end() const { return at_ == bytes_.size(); }

    template <typename T>
    T next()
    {
        require(sizeof(T));
        const T value = take<T>(&bytes_[at_]);
        at_ += sizeof(T);
        return value;
    }
    /// A count of 1, 2 or 4 bytes, by the hint 0, 1 or 2.
    std::uint32_t next_count(std::uint32_t hint)
    {
        if (hint == 0)
            return next<std::uint8_t>();
        return hint == 1 ? next<std::uint16_t>() : next<std::uint32_t>();
    }
    std::string next_text(size_t length)
    {
        require(length);
        at_ += length;
        return bytes_.substr(at_ - length, length);
    }

private:
    void require(size_t count) const
    {
        if (bytes_.size() - at_ < count)
            file_.refuse(node_, "a list of names ends early");
    }

    const OgawaReader& file_;
    OgawaNode node_;
    std::string bytes_;
    size_t at_ = 0;
};

/// Number of the sample in the file: those before the first and after the last change are not repeated.
int stored_sample(const AbcReadProperty& property, int index)
{
    if (property.last_changed == 0 || index < property.first_changed)
        return 0;
    return std::min(index, property.last_changed) - property.first_changed + 1;
}

} // namespace

bool AbcReadObject::is(const std::string& type) const
{
    return metadata.find("schema=AbcGeom_" + type + "_v") != std::string::npos;
}

AbcReader::AbcReader(const std::filesystem::path& file) : file_(file)
{
    const std::vector<OgawaNode> root = file_.group(file_.root());
    if (root.size() < 6)
        file_.refuse(file_.root(), "the root has " + std::to_string(root.size()) + " nodes, not 6");
    archive_metadata_ = file_.data(root[3]);
    read_times(root[4]);
    read_metadata(root[5]);
    objects_.push_back({"", "", -1});
    read_objects(root[2], 0, 0);
}

std::vector<double> AbcReader::times_of(const AbcReadProperty& property, int object) const
{
    if (size_t(property.time_sampling) >= times_.size())
        throw InvalidInput(path().string() + ": a property names the times " +
                           std::to_string(property.time_sampling) + "; the archive has " +
                           std::to_string(times_.size()));
    const Cycle& cycle = times_[size_t(property.time_sampling)];
    const int count = std::max(int(cycle.starts.size()), 1);
    std::vector<double> times;
    for (int k = 0; k < property.samples; ++k) {
        const double start = cycle.starts.empty() ? 0.0 : cycle.starts[size_t(k % count)];
        const int repetition = k / count;
        times.push_back(repetition == 0 ? start : start + repetition * cycle.duration);
    }
    if (const std::string fault = fault_of_times(times); !fault.empty())
        refuse(object, fault + "; export it again");
    return times;
}

std::string AbcReader::path_of(int object) const
{
    std::string path;
    for (int at = object; at > 0; at = objects_[size_t(at)].parent)
        path.insert(0, "/" + objects_[size_t(at)].name);
    return path;
}

void AbcReader::refuse(int object, const std::string& why) const
{
    throw InvalidInput(path().string() + ": " + path_of(object) + ": " + why);
}

void AbcReader::read_times(OgawaNode node)
{
    for (Headers list(file_, node); !list.is_at_end();) {
        list.next<std::uint32_t>(); // number of samples
        Cycle times;
        times.duration = list.next<double>();
        for (auto count = list.next<std::uint32_t>(); count > 0; --count)
            times.starts.push_back(list.next<double>());
        const bool are_finite =
            std::all_of(times.starts.begin(), times.starts.end(), [](double t) { return std::isfinite(t); });
        if (!are_finite || !std::isfinite(times.duration) || times.duration < 0.0)
            file_.refuse(node, "times of samples are not finite");
        times_.push_back(std::move(times));
    }
}

std::string AbcReader::value_of(const std::string& key) const
{
    const size_t at = (";" + archive_metadata_).find(";" + key + "=");
    if (at == std::string::npos)
        return "";
    const size_t begin = at + key.size() + 1;
    return archive_metadata_.substr(begin, archive_metadata_.find(';', begin) - begin);
}

std::optional<double> AbcReader::frames_per_second() const
{
    const std::optional<double> rate = number_in(value_of("FramesPerTimeUnit"));
    return rate && *rate > 0.0 ? rate : std::nullopt;
}

void AbcReader::read_metadata(OgawaNode node)
{
    metadata_.push_back("");
    for (Headers list(file_, node); !list.is_at_end();) {
        const auto length = list.next<std::uint8_t>();
        metadata_.push_back(list.next_text(length));
    }
}

/// Reads the children of objects_[parent]. @param group  of the parent
void AbcReader::read_objects(OgawaNode group, int parent, int depth)
{
    const std::vector<OgawaNode> nodes = file_.group(group);
    if (depth > kMaxDepth)
        file_.refuse(group, "more than " + std::to_string(kMaxDepth) + " objects lie above each other");
    if (nodes.empty())
        return;
    if (!read_.insert(group).second)
        file_.refuse(group, "an object occurs twice");
    if (!OgawaReader::is_data(nodes.front()))
        objects_[size_t(parent)].properties = nodes.front();
    if (!OgawaReader::is_data(nodes.back()))
        return;
    if (nodes.back() != kOgawaData && !read_.insert(nodes.back()).second)
        file_.refuse(group, "names of objects occur twice");
    Headers list(file_, nodes.back());
    list.leave_out_at_end(kHashes);
    for (size_t k = 1; !list.is_at_end(); ++k) {
        const auto length = list.next<std::uint32_t>();
        if (length > kMaxName)
            file_.refuse(group, "a name has " + std::to_string(length) + " characters");
        AbcReadObject object{list.next_text(length), "", parent};
        if (const std::uint32_t number = list.next<std::uint8_t>(); number == kInlineMetadata) {
            const auto size = list.next<std::uint32_t>();
            object.metadata = list.next_text(size);
        } else if (number < metadata_.size()) {
            object.metadata = metadata_[number];
        }
        if (k + 1 >= nodes.size())
            file_.refuse(group, "more objects are named than there are");
        if (objects_.size() > size_t(kMaxObjects))
            file_.refuse(group, "there are more than " + std::to_string(kMaxObjects) + " objects");
        objects_.push_back(std::move(object));
        read_objects(nodes[k], int(objects_.size()) - 1, depth + 1);
    }
}

std::vector<AbcReadProperty> AbcReader::properties(OgawaNode compound) const
{
    const std::vector<OgawaNode> nodes = file_.group(compound);
    std::vector<AbcReadProperty> all;
    if (nodes.empty() || !OgawaReader::is_data(nodes.back()))
        return all;
    for (Headers list(file_, nodes.back()); !list.is_at_end();) {
        const auto info = list.next<std::uint32_t>();
        const std::uint32_t hint = info >> 2 & 3, number = info >> 20 & 0xff;
        AbcReadProperty property;
        property.is_compound = (info & 3) == 0;
        if (!property.is_compound) {
            property.kind = (info & 3) == 1 ? AbcProperty::Kind::Scalar : AbcProperty::Kind::Array;
            property.type = int(info >> 4 & 15);
            property.extent = int(info >> 12 & 0xff);
            const std::uint32_t samples = list.next_count(hint);
            if (samples > kMaxSamples)
                file_.refuse(compound, "a property has " + std::to_string(samples) + " samples");
            property.samples = int(samples);
            const bool is_constant = (info >> 11 & 1) != 0;
            property.first_changed = is_constant ? 0 : 1;
            property.last_changed = is_constant ? 0 : std::max(property.samples - 1, 0);
            if ((info >> 9 & 1) != 0) {
                property.first_changed = int(std::min(list.next_count(hint), kMaxSamples));
                property.last_changed = int(std::min(list.next_count(hint), kMaxSamples));
            }
            if ((info >> 8 & 1) != 0)
                property.time_sampling = int(std::min(list.next_count(hint), kMaxSamples));
        }
        const std::uint32_t length = list.next_count(hint);
        property.name = list.next_text(length);
        if (number == kInlineMetadata) {
            const std::uint32_t size = list.next_count(hint);
            property.metadata = list.next_text(size);
        } else if (number < metadata_.size()) {
            property.metadata = metadata_[number];
        }
        if (all.size() + 1 >= nodes.size())
            file_.refuse(compound, "more properties are named than there are");
        property.group = nodes[all.size()];
        all.push_back(std::move(property));
    }
    return all;
}

std::optional<AbcReadProperty> AbcReader::find(OgawaNode compound,
                                               const std::vector<std::string>& names) const
{
    std::optional<AbcReadProperty> found;
    for (const std::string& name : names) {
        if (found && !found->is_compound)
            return {};
        const std::vector<AbcReadProperty> all = properties(found ? found->group : compound);
        const auto at = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
        if (at == all.end())
            return {};
        found = *at;
    }
    if (found && !found->is_compound)
        found->nodes = file_.group(found->group);
    return found;
}

std::string AbcReader::sample(const AbcReadProperty& property, int index) const
{
    const std::vector<OgawaNode>& nodes = property.nodes;
    const bool is_array = property.kind == AbcProperty::Kind::Array;
    const size_t at = size_t(stored_sample(property, index)) * (is_array ? 2 : 1);
    if (index < 0 || index >= property.samples || at >= nodes.size())
        file_.refuse(property.group,
                     "sample " + std::to_string(index) + " of \"" + property.name + "\" is missing");
    const std::uint64_t size = file_.size(nodes[at]);
    if (size == 0)
        return {};
    if (size < kDigest)
        file_.refuse(nodes[at], "a sample of \"" + property.name + "\" has no digest");
    return file_.data(nodes[at], kDigest, size - kDigest);
}

} // namespace toile::exports
