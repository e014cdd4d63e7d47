#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/proximity/surface/surface_contacts.h"

namespace nearfit {

/// Pairs of triangles of two surfaces that are near at a pose, nearest first, so that what is near at another pose is
/// found by bounds alone. Built beside the servo thread, read by it. Holds indices: the surfaces must be those that it
/// was built for.
class TriangleList {
 public:
  /// The listed pairs that matter around another pose.
  struct Around {
    std::span<const TrianglePair> pairs;  ///< With `atLeast` at the list's own pose, ascending.
    double travel = 0.0;  ///< No point of the part moves farther from the list's pose to there [m].
    double within =
        0.0;  ///< Every pair nearer than this there is among them [m]; 0 or less: the list does not serve.
  };

  /// Lists the pairs nearer than a distance. If there are more than fit, or finding them takes more work, the list
  /// reaches less far, or not at all. Allocates.
  /// @param sceneFromPart  As for findNearbyTriangles.
  /// @param within         Max distance of a pair [m]; finite, > 0.
  /// @param maxPairs       Max number of pairs.
  /// @param maxWork        Bound on the work, in pairs of nodes.
  void build(const UnsidedSurface& scene, const UnsidedSurface& part, const RigidTransform& sceneFromPart,
             double within, LmdScratch& scratch, std::size_t maxPairs, std::uint64_t maxWork);

  /// Every pair nearer than this at the list's pose is there [m]; 0 if the list is of no use.
  double within() const noexcept { return within_; }

  /// Returns the pairs that matter at a pose. Real-time safe: O(log n).
  /// @param mostPairs  Max number of them; with fewer, less far.
  Around around(const RigidTransform& sceneFromPart, std::size_t mostPairs) const noexcept;

  /// Distance at a pose within which it holds every pair [m]; may be negative. Real-time safe.
  double reachAt(const RigidTransform& sceneFromPart) const noexcept {
    return around(sceneFromPart, pairs_.size()).within;
  }

 private:
  double travelTo(const RigidTransform& sceneFromPart) const noexcept;

  std::vector<TrianglePair> pairs_, found_;              ///< In order, and as they were found.
  std::vector<std::pair<double, std::uint32_t>> order_;  ///< `atLeast` of what was found, and its index.
  RigidTransform pose_;                                  ///< sceneFromPart
  glm::dvec3 centre_{0.0};                               ///< Middle of the part, in its own frame [m].
  double radius_ = 0.0;                                  ///< Of the part about that [m].
  double within_ = 0.0;
};

}  // namespace nearfit
