#include "collision/contact/cloth_contact.h"

#include <algorithm>

#include "collision/contact/cpu/cloth_contact.h"
#include "collision/contact/cuda/cloth_contact.h"

namespace toile::collision {

namespace {

/// Depth of facets below a round shape, relative to the gap of the cloth [-].
constexpr double kSagPerGap = 0.25;

/// Times that a pair stops cloth in a step when its pairs are searched for again: without a term that holds
/// it, the minimiser goes there for ever, by corrections too small for a search.
constexpr int kAgain = 3;

std::uint64_t key_of(const NearPair& pair)
{
    return (std::uint64_t(pair.first) << 32 | std::uint64_t(pair.second) << 1) + (pair.is_edge_edge ? 1 : 0);
}

} // namespace

ClothContact::ClothContact(ContactSoup soup)
    : soup_(std::move(soup)),
      rules_(soup_.triangles_of_cloth(), soup_.of_cloth(View<const Vec3>(soup_.positions)), soup_.cloths,
             soup_.of_cloth(View<const double>(soup_.altitude)), soup_.bodies.are_open()),
      exempt_(soup_.positions, soup_.altitude, CollisionFreeStep::Settings{}.min_gap),
      bodies_(soup_, rules_, exempt_), fixed_(soup_.positions.size(), 1), stopped_(fixed_.size(), 0)
{
}

void ClothContact::set_crossing(View<const unsigned char> crosses)
{
    std::vector<unsigned char> all(crosses.begin(), crosses.end());
    all.resize(soup_.positions.size(), 0);
    exempt_.set_crossing(all);
}

void ClothContact::forget() { bodies_.forget(); }

void ClothContact::begin(View<const unsigned char> fixed_cloth)
{
    std::copy_n(fixed_cloth.begin(), soup_.first_body, fixed_.begin());
    has_limited_ = false;
    if (has_stopped_)
        std::fill(stopped_.begin(), stopped_.end(), 0);
    times_blocked_.clear();
    has_stopped_ = false;
}

void ClothContact::mark_stopped(View<const BlockedPair> blocked)
{
    has_limited_ = !blocked.empty();
    has_stopped_ = has_stopped_ || has_limited_;
    stops_more_ = false;
    for (const BlockedPair& at : blocked) {
        stops_more_ = ++times_blocked_[key_of(at.pair)] == kAgain || stops_more_;
        for (const int v : at.pair.vertex) {
            stops_more_ = stops_more_ || stopped_[v] == 0;
            stopped_[v] = 1;
        }
    }
}

std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude,
                                                 const std::vector<ContactCollider>& colliders,
                                                 bool cloth_with_cloth, const CudaSpace* space)
{
    BodySurfaces bodies(colliders, kSagPerGap * largest_gap(cloths));
    if (!cloth_with_cloth && bodies.is_empty())
        return nullptr;
    ContactSoup soup(triangles, positions, cloths, altitude, std::move(bodies), cloth_with_cloth);
    if (space != nullptr)
        return std::make_unique<DeviceClothContact>(*space, std::move(soup));
    return std::make_unique<HostClothContact>(std::move(soup));
}

} // namespace toile::collision
