#pragma once

#include <cstdint>

namespace nearfit {

/// Rule by which a pair of features counts as a local minimum distance. A hierarchy is built for one rule.
enum class AcceptanceRule : std::uint8_t {
  Exact,  ///< The conditions that define a minimum.
  /// Approximate, as in Johnson & Willemsen 2003: the two points are nearest between a pair of triangles, and
  /// the segment between them lies in the span of the surface normals at each end. See normal_span.h.
  NormalSpan,
};

}  // namespace nearfit
