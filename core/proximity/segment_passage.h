#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// A straight way between two points, closed once triangles lie across all of it: it is eight lines parallel
/// to the segment, a clearance away from it all around, and each triangle bars those that cross it. A surface
/// that the segment passes through bars all eight; one that it only touches (with its ends, along an edge,
/// along a face) leaves some open.
///
/// Watertight: corners are rounded once each to the plane across the segment, and on which side of an edge a
/// line passes is decided exactly there, so that no line slips between triangles that share an edge or a
/// vertex. Source: Woop, Benthin & Wald 2013, in double precision, with ties broken as if the line had been
/// moved by next to nothing (Edelsbrunner & Muecke 1990). Real-time safe.
class SegmentPassage {
 public:
  /// @param start, direction  Of the segment; the direction is unit.
  /// @param from, to          What of it counts, as distances from the start [m].
  /// @param clearance         Distance of the lines from the segment [m]; > 0.
  SegmentPassage(const glm::dvec3& start, const glm::dvec3& direction, double from, double to,
                 double clearance) noexcept;

  /// Bars the lines that cross the triangle.
  void add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept;

  bool isClosed() const noexcept { return barred_ == kAll; }

 private:
  static constexpr std::uint32_t kLines = 8, kAll = (1U << kLines) - 1U;

  std::uint32_t linesAcross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) const noexcept;

  glm::dvec3 start_, x_, y_, z_;
  double from_, to_, clearance_;
  std::uint32_t barred_ = 0;
};

}  // namespace nearfit
