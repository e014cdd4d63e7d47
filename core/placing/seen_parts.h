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
  bool isOpaque = true;  ///< If false, what lies behind is visible too.
  bool isCut = false;    ///< The cut plane removes part of it.
};

/// A box of pixels of a view (see ViewProjection), both corners included.
struct PixelBox {
  glm::ivec2 lower{0}, upper{0};
};

/// The parts visible in a box of pixels, in the order of `parts`. A part is visible at a pixel if no opaque
/// part is in front of it there. Parts smaller than a pixel may be missed.
///
/// A closed part that is cut open is visible at its cut face, where its inside is in front. Time is
/// proportional to the triangles of the parts whose bounding boxes reach the pixels, plus the
/// number of pixels.
/// @param cut  In the world frame; applies to parts with isCut.
std::vector<PartId> partsSeenIn(std::span<const ShownPart> parts, const ViewProjection& view,
                                const PixelBox& pixels, const std::optional<CutPlane>& cut = std::nullopt);

}  // namespace nearfit
