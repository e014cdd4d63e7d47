#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// A triangle mesh in the caller's arrays, in the frame that both meshes of a search share.
struct MeshArrays {
  std::span<const glm::dvec3> vertices;  ///< Finite [m].
  std::span<const std::array<std::uint32_t, 3>>
      triangles;  ///< Indices of vertices, anticlockwise from outside.
};

/// Called now and then during long work; false stops it. May be empty.
using GoOn = std::function<bool()>;

/// Curves in which two surfaces meet.
struct IntersectionCurves {
  /// Each of two points or more; a closed curve ends in its first point. Where triangles lie in one plane, the outline
  /// of what they share.
  std::vector<std::vector<glm::dvec3>> polylines;
  bool isComplete = true;  ///< False if `maxPairs` or the caller stopped the search.
};

/// Finds the curves in which two triangle meshes meet. Meshes may be open and cross themselves. Which triangles meet, and
/// which ends of their segments are one point, is decided exactly; the points are rounded to double precision. Single
/// points of contact are no curves. Triangles without area do not count.
/// @param maxPairs  Max number of pairs of triangles whose boxes overlap.
/// O(n log n) besides those pairs, some microseconds each if they do not meet, and some tens if they do. Allocates.
IntersectionCurves findIntersectionCurves(const MeshArrays& a, const MeshArrays& b, std::size_t maxPairs,
                                          const GoOn& goOn = {});

/// Reason why a volume is not known.
enum class VolumeProblem : std::uint8_t {
  None,
  Open,           ///< A mesh is not closed.
  NotManifold,    ///< Edges of a mesh have more than two faces, or its sheets touch in a vertex.
  NoArea,         ///< A mesh has triangles without area.
  InsideOut,      ///< A mesh does not enclose what it bounds: its faces point inward, or disagree.
  CrossesItself,  ///< A mesh crosses itself.
  TooLarge,       ///< There are more triangles, or pairs of them that meet, than the caller allows.
  Failed,         ///< The construction failed, as where the intersection itself touches itself along an edge.
  Stopped,        ///< By the caller.
};

/// Volume that two solids share.
struct IntersectionVolume {
  std::optional<double> volume;  ///< [m^3]; no value if there is a problem.
  VolumeProblem problem = VolumeProblem::None;
};

/// Finds the volume of the intersection of the solids that two meshes bound, also of one inside the other: CGAL's
/// corefinement, whose constructions are exact. Only the result's points are rounded to double precision.
///
/// Both meshes must be closed, manifold, oriented outward and free of self-crossings. What is crossing or wrong near the
/// intersection is found here; the caller must exclude self-crossings elsewhere.
/// @param maxTriangles  Max number of triangles of both meshes.
/// @param maxPairs      Max number of pairs of an edge and a triangle that meet.
/// O(n log n) for few pairs. Allocates some hundred bytes a triangle. Throws nothing.
IntersectionVolume findIntersectionVolume(const MeshArrays& a, const MeshArrays& b, std::size_t maxTriangles,
                                          std::size_t maxPairs, const GoOn& goOn = {});

}  // namespace nearfit
