#include "core/mesh/colouring.h"

namespace toile {

std::vector<std::vector<int>> colour_items(const Incidence& keys_of_item, int key_count)
{
    std::vector<std::vector<int>> items_of_colour;
    std::vector<std::vector<int>> colours_of_key(key_count);
    std::vector<int> last_item_near; // [colours] last item with a key that has this colour
    const int items = int(keys_of_item.first.size()) - 1;
    for (int item = 0; item < items; ++item) {
        for (const int key : keys_of_item.of(item))
            for (const int colour : colours_of_key[key])
                last_item_near[colour] = item;
        int colour = 0;
        while (colour < int(last_item_near.size()) && last_item_near[colour] == item)
            ++colour;
        if (colour == int(last_item_near.size())) {
            last_item_near.push_back(-1);
            items_of_colour.emplace_back();
        }
        items_of_colour[colour].push_back(item);
        for (const int key : keys_of_item.of(item))
            colours_of_key[key].push_back(colour);
    }
    return items_of_colour;
}

std::vector<std::vector<int>> colour_triangles(View<const Triangle> triangles, int vertex_count)
{
    Incidence vertices;
    vertices.first.push_back(0);
    for (const Triangle& t : triangles) {
        vertices.items.insert(vertices.items.end(), t.begin(), t.end());
        vertices.first.push_back(int(vertices.items.size()));
    }
    return colour_items(vertices, vertex_count);
}

} // namespace toile
