#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "avatars/import/gltf_json.h"

namespace toile::avatars {

/// True for a URI that holds its data itself.
bool is_data_uri(std::string_view uri);

/// Data of a URI "data:...;base64,...".
/// @param uri  the JSON string, named in errors
/// @throws InvalidInput for another encoding, and the first character that is not base64.
std::vector<unsigned char> decode_data_uri(const GltfValue& uri);

/// Path that a relative URI names: %20 becomes a blank.
/// @throws InvalidInput for a URI with a scheme, such as https:.
std::string decode_path(const GltfValue& uri);

} // namespace toile::avatars
