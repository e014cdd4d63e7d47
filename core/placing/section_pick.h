#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/placing/feature_pick.h"
#include "core/section/mesh_section.h"

namespace nearfit {

/// The feature that a user points at on a cap: a nearby segment of the outline, as an edge, otherwise the
/// point itself. std::nullopt for FeatureFilter::Faces, and for Axes if no segment is near.
/// @param point  On the cap, in the mesh's frame [m]; set to the nearest point of the segment found.
/// @param reach  Max distance to the outline [m]; >= 0.
std::optional<PickedFeature> pickFeature(const MeshSection& section, glm::dvec3& point, double reach,
                                         FeatureFilter filter = FeatureFilter::Any);

}  // namespace nearfit
