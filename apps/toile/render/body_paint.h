#pragma once

#include <functional>
#include <memory>
#include <string>

#include "apps/preview/paint/paint.h"
#include "scenes/colliders/scene_body.h"

namespace toile::app {

/// Colours of a body by its file; null for a body without a file or without colours in it, and for caches.
/// @param warn  receives what can't be shown, one line each
std::shared_ptr<const preview::Paint> paint_of(const scenes::SceneBody& body,
                                               const std::function<void(const std::string&)>& warn);

} // namespace toile::app
