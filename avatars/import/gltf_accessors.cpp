#include "avatars/import/gltf_accessors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

constexpr std::uint64_t kFirstComponentType = 5120;

int width_of(std::string_view type)
{
    if (type == "SCALAR")
        return 1;
    return type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

size_t size_of(unsigned component_type)
{
    if ((component_type & (kByte | kUnsignedByte)) != 0)
        return 1;
    return (component_type & (kShort | kUnsignedShort)) != 0 ? 2 : 4;
}

unsigned component_type_of(const GltfValue& accessor, unsigned allowed)
{
    static constexpr std::array<std::pair<unsigned, const char*>, 6> kNames{
        {{kByte, "5120 BYTE"},
         {kUnsignedByte, "5121 UNSIGNED_BYTE"},
         {kShort, "5122 SHORT"},
         {kUnsignedShort, "5123 UNSIGNED_SHORT"},
         {kUnsignedInt, "5125 UNSIGNED_INT"},
         {kFloat, "5126 FLOAT"}}};
    const GltfValue value = accessor.at("componentType");
    const unsigned type =
        1u << (value.whole(kFirstComponentType, kFirstComponentType + 6) - kFirstComponentType);
    if ((type & allowed) == 0) {
        std::string list;
        for (const auto& [known, name] : kNames)
            if ((known & allowed) != 0)
                list += (list.empty() ? "" : ", ") + std::string(name);
        value.refuse("it is used where glTF has only " + list);
    }
    return type;
}

template <typename Component>
void decode(const unsigned char* from, size_t stride, int count, int width, bool normalised, double* to)
{
    const double scale = normalised ? 1.0 / double(std::numeric_limits<Component>::max()) : 1.0;
    for (int i = 0; i < count; ++i, from += stride)
        for (int k = 0; k < width; ++k) {
            Component component;
            std::memcpy(&component, from + size_t(k) * sizeof(Component), sizeof(Component));
            const double value = double(component);
            // -128 and -127 are both -1.
            *to++ = normalised ? std::max(scale * value, -1.0) : value;
        }
}

void decode(unsigned component_type, bool normalised, const unsigned char* from, size_t stride, int count,
            int width, double* to)
{
    switch (component_type) {
    case kByte:
        return decode<std::int8_t>(from, stride, count, width, normalised, to);
    case kUnsignedByte:
        return decode<std::uint8_t>(from, stride, count, width, normalised, to);
    case kShort:
        return decode<std::int16_t>(from, stride, count, width, normalised, to);
    case kUnsignedShort:
        return decode<std::uint16_t>(from, stride, count, width, normalised, to);
    case kUnsignedInt:
        return decode<std::uint32_t>(from, stride, count, width, normalised, to);
    default:
        return decode<float>(from, stride, count, width, false, to);
    }
}

void require_finite(const Elements& elements, const GltfValue& reference)
{
    const auto bad = std::find_if(elements.values.begin(), elements.values.end(),
                                  [](double value) { return !std::isfinite(value); });
    if (bad == elements.values.end())
        return;
    const size_t at = size_t(bad - elements.values.begin());
    reference.refuse("number " + std::to_string(at % size_t(elements.width)) + " of element " +
                     std::to_string(at / size_t(elements.width)) + " of this accessor is " +
                     std::to_string(*bad) + "; all must be finite");
}

bool flag_of(const GltfValue& object, const char* key)
{
    const std::optional<GltfValue> value = object.find(key);
    return value && value->flag();
}

} // namespace

Elements GltfAccessors::read(const GltfValue& reference, const AccessorRule& rule, int count)
{
    Elements elements = read(reference, rule);
    if (elements.count != count)
        reference.refuse("this accessor has " + std::to_string(elements.count) + " elements; " +
                         std::to_string(count) + " are needed here");
    return elements;
}

Elements GltfAccessors::read(const GltfValue& reference, const AccessorRule& rule)
{
    // Read the accessor's own properties.
    const GltfValue accessors = file_.list("accessors");
    const GltfValue accessor = accessors[reference.index(accessors.size(), "accessors")];
    if (const GltfValue type = accessor.at("type"); type.text() != rule.type)
        type.refuse("it is used where glTF has only " + std::string(rule.type));
    const unsigned component_type = component_type_of(accessor, rule.component_types);
    const bool normalised = flag_of(accessor, "normalized") && component_type != kFloat;

    // Copy the elements from their view; without one they are zero.
    const GltfValue count = accessor.at("count");
    Elements elements;
    elements.count = int(count.whole(1, std::numeric_limits<int>::max()));
    elements.width = width_of(rule.type);
    Range source;
    if (accessor.find("bufferView"))
        source = range(accessor, count, size_of(component_type) * size_t(elements.width));
    file_.spend(count, std::uint64_t(elements.count));
    elements.values.resize(size_t(elements.count) * size_t(elements.width), 0.0);
    if (!source.bytes.empty())
        decode(component_type, normalised, source.bytes.data(), source.stride, elements.count, elements.width,
               elements.values.data());

    if (accessor.find("sparse"))
        replace_sparse(accessor, component_type, normalised, elements);
    require_finite(elements, reference);
    return elements;
}

/// Bytes of the view that `owner` (an accessor, or a part of a sparse one) names, from the owner's offset on.
GltfAccessors::Range GltfAccessors::range(const GltfValue& owner, const GltfValue& count, size_t element_size)
{
    const GltfValue views = file_.list("bufferViews");
    const GltfValue view = views[owner.at("bufferView").index(views.size(), "bufferViews")];
    const Bytes bytes = file_.view(view);
    const std::uint64_t length = bytes.size();

    // The elements must lie in the view.
    Range range;
    range.stride = element_size;
    if (const std::optional<GltfValue> stride = view.find("byteStride"))
        range.stride = size_t(stride->whole(element_size, std::max<std::uint64_t>(252, element_size)));
    const std::uint64_t offset = offset_of(owner);
    const std::uint64_t element_count = count.whole(1, std::numeric_limits<int>::max());
    if (offset > length || length - offset < element_size ||
        (length - offset - element_size) / range.stride < element_count - 1)
        count.refuse("elements of " + std::to_string(element_size) + " bytes, " +
                     std::to_string(range.stride) + " apart, from offset " + std::to_string(offset) +
                     " end after their view of " + std::to_string(length) + " bytes");
    range.bytes = bytes.subspan(size_t(offset));
    return range;
}

void GltfAccessors::replace_sparse(const GltfValue& accessor, unsigned component_type, bool normalised,
                                   Elements& elements)
{
    const GltfValue sparse = accessor.at("sparse"), indices = sparse.at("indices"),
                    values = sparse.at("values");
    const GltfValue count_value = sparse.at("count");
    const int count = int(count_value.whole(1, std::uint64_t(elements.count)));
    const unsigned index_type = component_type_of(indices, kUnsignedByte | kUnsignedShort | kUnsignedInt);
    const size_t width = size_t(elements.width);

    const Range from_indices = range(indices, count_value, size_of(index_type));
    std::vector<double> which(static_cast<size_t>(count));
    decode(index_type, false, from_indices.bytes.data(), from_indices.stride, count, 1, which.data());
    const Range from_values = range(values, count_value, size_of(component_type) * width);
    std::vector<double> replacements(size_t(count) * width);
    decode(component_type, normalised, from_values.bytes.data(), from_values.stride, count, elements.width,
           replacements.data());

    for (int i = 0; i < count; ++i) {
        if (!(which[size_t(i)] < elements.count) || (i > 0 && which[size_t(i)] <= which[size_t(i) - 1]))
            throw InvalidInput(indices.place() + ": index " + std::to_string(i) + " is " +
                               std::to_string(std::uint64_t(which[size_t(i)])) +
                               "; indices must ascend and be below " + std::to_string(elements.count));
        std::copy_n(replacements.begin() + i * elements.width, width,
                    elements.values.begin() + std::ptrdiff_t(which[size_t(i)]) * elements.width);
    }
}

} // namespace toile::avatars
