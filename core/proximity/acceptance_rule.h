#pragma once

#include <cstdint>

namespace nearfit {

/// When a pair of features counts as a local minimum distance. A hierarchy is built for one rule.
enum class AcceptanceRule : std::uint8_t {
  Exact,  ///< The conditions of the definition of a minimum.
  /// As in Johnson & Willemsen 2003, approximate: the two points are nearest between a pair of triangles, and
  /// the way between them lies in the span of the surface normals at each. See normal_span.h.
  NormalSpan,
};

}  // namespace nearfit
