#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "export/axes.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Exports of the scene: its list, or one PC2 per cloth and solid.
std::vector<scene::Export> exports_of(const scenes::Scene& scene);

/// Indices in scenes::surface_names() of the surfaces that an export writes.
std::vector<int> surfaces_of(const scenes::Scene& scene, const scene::Export& entry);

/// Number of the first frame in an export's file.
int start_frame_of(const scene::Export& entry);

exports::Axes axes_of(const scene::Export& entry);

/// Samples that an export has of a scene.
int sample_count(const scenes::Scene& scene, const scene::Export& entry);

/// Of several entries, the one that a surface is checked by: read without another program, if there is one.
/// @return its index; none if no export that is read back has the surface
std::optional<size_t> export_to_check(const scenes::Scene& scene, const std::vector<scene::Export>& entries,
                                      int surface);

/// Samples per frame that the scene's exports need.
int subframes_of(const scenes::Scene& scene);

/// The scene with a sample at each subframe: sample k is at the time of frame k / subframes.
scenes::Scene with_subframes(scenes::Scene scene, int subframes);

} // namespace toile::app
