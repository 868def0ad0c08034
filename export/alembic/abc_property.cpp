#include "export/alembic/abc_property.h"

#include <algorithm>

#include "core/compute/hash.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

// Bits of the first word of a property's header.
constexpr std::uint32_t kCompound = 0, kHasTimeSampling = 1 << 8, kIsHomogeneous = 1 << 10,
                        kIsConstant = 1 << 11, kInlineMetadata = 0xffu << 20;
constexpr int kSizeHintBit = 2, kTypeBit = 4, kExtentBit = 12;

std::string digest_of(std::string_view content)
{
    Hasher hasher;
    hasher.add(content);
    const Hash128 hash = hasher.result();
    std::string digest;
    append(digest, hash.high);
    append(digest, hash.low);
    return digest;
}

/// Width of the counts in a header: 1, 2 or 4 bytes.
class Counts {
public:
    explicit Counts(std::size_t largest) : hint_(largest < 1u << 8 ? 0 : largest < 1u << 16 ? 1 : 2) {}
    std::uint32_t bits() const { return std::uint32_t(hint_) << kSizeHintBit; }
    void put(std::string& bytes, std::size_t count) const
    {
        if (hint_ == 0)
            append(bytes, std::uint8_t(count));
        else if (hint_ == 1)
            append(bytes, std::uint16_t(count));
        else
            append(bytes, std::uint32_t(count));
    }
    void put_text(std::string& bytes, const std::string& text) const
    {
        put(bytes, text.size());
        bytes += text;
    }

private:
    int hint_;
};

} // namespace

void AbcProperty::add_sample(OgawaFile& file, std::string_view bytes)
{
    // Readers keep samples by their digests, so a digest stands for one content.
    const std::string digest = digest_of(bytes);
    if (!samples_.empty() && digest == last_digest_) {
        samples_.push_back(samples_.back());
        return;
    }
    last_digest_ = digest;
    samples_.push_back(file.add_data(digest + std::string(bytes)));
}

OgawaNode AbcProperty::add_group(OgawaFile& file) const
{
    if (layout_.kind == Kind::Scalar)
        return file.add_group(samples_);
    std::vector<OgawaNode> children;
    for (const OgawaNode sample : samples_) {
        children.push_back(sample);
        children.push_back(kOgawaData); // dimensions: as many values as there are
    }
    return file.add_group(children);
}

std::string AbcProperty::header() const
{
    const Counts counts(std::max({layout_.name.size(), layout_.metadata.size(), samples_.size()}));
    std::uint32_t info = std::uint32_t(layout_.kind) | counts.bits() |
                         std::uint32_t(layout_.type) << kTypeBit |
                         std::uint32_t(layout_.extent) << kExtentBit | kIsHomogeneous | kInlineMetadata;
    info |= layout_.time_sampling > 0 ? kHasTimeSampling : 0;
    info |= is_constant() ? kIsConstant : 0;
    std::string bytes;
    append(bytes, info);
    counts.put(bytes, samples_.size());
    if (layout_.time_sampling > 0)
        counts.put(bytes, std::size_t(layout_.time_sampling));
    counts.put_text(bytes, layout_.name);
    counts.put_text(bytes, layout_.metadata);
    return bytes;
}

OgawaNode AbcCompound::add_group(OgawaFile& file) const
{
    std::vector<OgawaNode> children;
    std::string headers;
    for (const AbcProperty* property : properties) {
        children.push_back(property->add_group(file));
        headers += property->header();
    }
    for (const AbcCompound& compound : compounds) {
        children.push_back(compound.add_group(file));
        headers += compound.header();
    }
    if (!headers.empty())
        children.push_back(file.add_data(headers));
    return file.add_group(children);
}

std::string AbcCompound::header() const
{
    const Counts counts(std::max(name.size(), metadata.size()));
    std::string bytes;
    append(bytes, kCompound | counts.bits() | kInlineMetadata);
    counts.put_text(bytes, name);
    counts.put_text(bytes, metadata);
    return bytes;
}

} // namespace toile::exports
