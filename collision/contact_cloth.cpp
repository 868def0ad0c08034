#include "collision/contact_cloth.h"

#include <algorithm>

namespace toile {

std::vector<int> rigid_bodies_of(const std::vector<ContactCloth>& cloths)
{
    std::vector<int> bodies;
    int count = 0;
    for (const ContactCloth& cloth : cloths)
        bodies.insert(bodies.end(), cloth.vertex_count, cloth.is_rigid ? count++ : -1);
    if (count == 0)
        bodies.clear();
    return bodies;
}

double largest_gap(const std::vector<ContactCloth>& cloths)
{
    double largest = 0.0;
    for (const ContactCloth& cloth : cloths)
        largest = std::max(largest, cloth.gap);
    return largest;
}

ContactTables::ContactTables(const std::vector<ContactCloth>& cloths, int partner_count)
    : partner_friction(cloths.size() * partner_count, 0.0), cloth_friction(cloths.size() * cloths.size(), 0.0)
{
    for (size_t c = 0; c < cloths.size(); ++c) {
        const ContactCloth& cloth = cloths[c];
        cloth_of.insert(cloth_of.end(), cloth.vertex_count, int(c));
        gap.push_back(cloth.gap);
        std::copy_n(cloth.partner_friction.begin(),
                    std::min<size_t>(cloth.partner_friction.size(), partner_count),
                    partner_friction.begin() + c * partner_count);
        std::copy_n(cloth.cloth_friction.begin(), std::min(cloth.cloth_friction.size(), cloths.size()),
                    cloth_friction.begin() + c * cloths.size());
    }
}

} // namespace toile
