#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Passage along a straight segment, closed once triangles lie across all of it. It consists of eight lines
/// parallel to the segment, at a clearance all around; each triangle bars the lines that cross it. A surface
/// that the segment passes through bars all eight. One that it only touches (with its ends, along an edge,
/// along a face) leaves some open.
///
/// Watertight: each corner is rounded once to the plane across the segment, and the side on which a line
/// passes an edge is decided exactly there, so no line slips between triangles that share an edge or a
/// vertex. Source: Woop, Benthin & Wald 2013, in double precision; ties are broken by an infinitesimal shift
/// of the line (Edelsbrunner & Muecke 1990). Real-time safe.
class SegmentPassage {
 public:
  /// @param start, direction  Start of the segment [m] and its unit direction.
  /// @param from, to          Range of the segment that counts, as distances from the start [m].
  /// @param clearance         Distance of the lines from the segment [m]; > 0.
  SegmentPassage(const glm::dvec3& start, const glm::dvec3& direction, double from, double to,
                 double clearance) noexcept;

  /// Bars the lines that cross the triangle.
  void add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept;

  /// True once every line is barred.
  bool isClosed() const noexcept { return barred_ == kAll; }

 private:
  static constexpr std::uint32_t kLines = 8, kAll = (1U << kLines) - 1U;

  std::uint32_t linesAcross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) const noexcept;

  glm::dvec3 start_, x_, y_, z_;
  double from_, to_, clearance_;
  std::uint32_t barred_ = 0;
};

}  // namespace nearfit
