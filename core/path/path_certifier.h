#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A stretch of a path on which a part is proven free of another: at the anchor their surfaces are at least `bound`
/// apart, and from there to either end no point of the part moves farther than `bound` less the separation.
struct ProvenStretch {
  double from = 0.0, anchor = 0.0, to = 0.0;  ///< Places on the path.
  double bound = 0.0;                         ///< [m]
};

/// Proof that a part on a path stays free of another: stretches that cover the path, in order, each from where the one
/// before ends.
struct PairProof {
  PartId part{}, other{};
  std::vector<ProvenStretch> stretches;
};

/// The first place where a path is not proven free, to within a travel of a 16th of the separation.
struct UnprovenPlace {
  double place = 0.0, time = 0.0;  ///< Place on the path, time [s].
  PartId part{}, other{};
  double distance = 0.0;  ///< Lower bound on the distance of the surfaces there [m].
  bool isInside = false;  ///< True if one part is in the other, or meets it, at the start of the path.
};

/// Result of certifying a path.
struct PathProof {
  double separation = 0.0;       ///< [m]
  std::vector<PairProof> pairs;  ///< Empty if the path is not proven.
  std::optional<UnprovenPlace> unproven;

  bool isFree() const noexcept { return !unproven.has_value(); }
};

/// A motion from one pose to another, as between two poses of a path.
struct PathSegment {
  RigidTransform from, to;  ///< worldFromLead
};

/// Separation to certify with if none is given: a millionth of the diagonal of the smallest moving part, at most 1 um,
/// unless parts are so far away that rounding needs more. Throws UsageError as pathBodies().
double defaultSeparation(const Scene& scene, const AssemblyPath& path);

/// Proves that paths of a part, or of parts that move as one, keep a separation from all other visible parts: not at
/// poses, but everywhere between them. Conservative advancement: where two surfaces are a distance d apart, no point of
/// the part comes nearer than the separation s before it has travelled d - s.
///
/// Distances are those of the searched meshes, less their deviation and all rounding, so the proof is of the meshes as
/// loaded. What is proven may be refused where the distance is less than 17/16 of the separation.
/// Source: Mirtich 1996; Tang, Kim and Manocha 2009 (C2A), with stretches over many poses.
class PathCertifier {
 public:
  /// @param path        Its parts and its centre count; its poses do not.
  /// @param separation  [m]; > 0.
  /// Builds missing hierarchies. Throws UsageError if the separation is invalid or less than rounding, or as
  /// pathBodies(), or if a mesh has triangles too thin to judge; Cancelled.
  PathCertifier(const Scene& scene, const AssemblyPath& path, double separation,
                const ProgressCallback& progress = {});
  ~PathCertifier();
  PathCertifier(PathCertifier&&) noexcept;

  /// Proves a path, or finds the first place where it is not proven. On all processors; the result does not depend on
  /// their number. Throws UsageError as checkPath(); Cancelled.
  PathProof prove(const AssemblyPath& path, const ProgressCallback& progress = {}) const;

  /// By segment: 1 if it is proven that the surfaces keep the separation on it. Does not look if one part is inside
  /// another: where that is so at one end it is so at the other. On all processors. Throws Cancelled.
  /// @param maxDistances  Number of distances of two parts after which a segment counts as not proven. A segment takes
  ///                      as many as its length over twice the room beside it.
  std::vector<char> freeSegments(
      std::span<const PathSegment> segments, const ProgressCallback& progress = {},
      std::uint64_t maxDistances = std::numeric_limits<std::uint64_t>::max()) const;

  /// Radius of what moves about the centre [m].
  double radius() const noexcept;

 private:
  struct Search;
  std::unique_ptr<const Search> search_;
};

}  // namespace nearfit
