#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/placing/pivot.h"
#include "core/placing/view_projection.h"
#include "core/section/cut_plane.h"

namespace nearfit {

/// A part as a view shows it.
struct ShownPart {
  PlacedPart placed;
  bool isOpaque = true;  ///< Else what lies behind it is seen too.
  bool isCut = false;    ///< What the plane cuts away is not shown of it.
};

/// Pixels of a view (see ViewProjection), both corners among them.
struct PixelBox {
  glm::ivec2 lower{0}, upper{0};
};

/// The parts of which something is seen at the pixels of a box, in their order in `parts`. Something is seen
/// at a pixel where a part is met there before all opaque ones; what is smaller than a pixel may be missed.
///
/// Cut open, a closed part is seen where its cut face is: there its inside is met first. Takes time in
/// proportion to the triangles of the parts whose boxes reach into the pixels, and to those pixels.
/// @param cut  In the world; counts for parts that are cut.
std::vector<PartId> partsSeenIn(std::span<const ShownPart> parts, const ViewProjection& view,
                                const PixelBox& pixels, const std::optional<CutPlane>& cut = std::nullopt);

}  // namespace nearfit
