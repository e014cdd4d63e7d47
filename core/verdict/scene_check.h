#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/exact/mesh_intersection.h"
#include "core/scene/pair_record.h"
#include "core/scene/scene.h"
#include "core/verdict/clash_depth.h"
#include "core/verdict/pair_rules.h"
#include "core/verdict/surface_depth.h"

namespace nearfit {

/// Max minima of a pair where all are asked for: far more than anyone looks at, and the work space stays within some
/// gigabytes.
constexpr std::size_t kMostMinima = 1'000'000;

/// A part where it is checked.
struct CheckedPart {
  PartId id{};
  RuledPart ruled;
  PartGeometryPtr geometry;  ///< Not null, with triangles.
  RigidTransform worldFromPart;
};

/// Parts, threshold and rules of a check.
struct SceneCheckRequest {
  std::vector<CheckedPart> parts;  ///< In ascending order of ID.
  double threshold = 0.0;          ///< Pairs no farther apart are found [m]; finite, >= 0.
  std::vector<PairRule> rules;
  /// Max minima kept of a pair, the nearest; 0: all, up to kMostMinima. A thread that finds many takes some 3 kB for each
  /// that its largest pair has, and each that is kept takes 64 bytes.
  std::size_t maxMinima = 100;
  /// Triangles of two parts beyond which the volume that they share is not computed; 0: no volumes.
  std::size_t maxVolumeTriangles = 1'000'000;
  bool hasDepths = true;       ///< Find depths of clashes.
  bool isLowPriority = false;  ///< Leave the processors to others, such as the servo.
};

/// Checks the visible parts of a scene that have a surface, by the scene's rules.
SceneCheckRequest sceneCheckRequest(const Scene& scene, double threshold);

/// A minimum below the threshold. World frame.
struct FoundMinimum {
  glm::dvec3 partPoint{0.0}, otherPoint{0.0};  ///< [m]
  double distance = 0.0;                       ///< [m]
  /// As in Lmd.
  bool isRegion = false, isBlocked = false, isMarginal = false;
};

/// How two parts clash. World frame.
struct ClashMeasures {
  /// Curves in which the surfaces meet; none if one part is inside the other.
  std::vector<std::vector<glm::dvec3>> curves;
  bool isEveryCurve = true;      ///< False if there was too much to search.
  std::optional<double> volume;  ///< Shared by the two [m^3].
  /// Why the volume is not known.
  VolumeProblem volumeProblem = VolumeProblem::None;
  /// A translation of the first part that frees it; no value if none was looked for or found.
  std::optional<FreeingTranslation> freeing;
  bool isDepthExact = false;  ///< No shorter translation frees it; else the depth is at most its length.
  /// How deep the surfaces lie in each other; only where a press fit is meant.
  std::optional<SurfaceDepth> interference;
};

/// Finding of a check for two parts. World frame.
struct PairFinding {
  PartPair pair;
  PairVerdict verdict = PairVerdict::Near;
  double distance = 0.0;  ///< Min distance of the surfaces [m]; 0 if they meet.
  /// Nearest points, on the pair's first part and on the other [m].
  glm::dvec3 partPoint{0.0}, otherPoint{0.0};
  std::vector<FoundMinimum> minima;      ///< Below the threshold, nearest first; none if they meet.
  bool isEveryMinimum = true;            ///< False if there are more than were kept.
  std::optional<ClashMeasures> clash;    ///< If the verdict is Clash or Contained.
  std::optional<std::size_t> allowedBy;  ///< Index of the rule that allows it.

  /// True if it is a clash, or a part inside another one, that no rule allows.
  bool isForbidden() const noexcept { return verdict >= PairVerdict::Clash && !allowedBy; }
  /// Length of the translation that frees the parts [m].
  std::optional<double> depth() const noexcept {
    return clash && clash->freeing ? std::optional(clash->freeing->length) : std::nullopt;
  }
};

/// A pair that a rule left out.
struct LeftOutPair {
  PartPair pair;
  std::size_t rule;  ///< Index.
};

/// Result of a check.
struct SceneCheck {
  double threshold = 0.0;  ///< [m]
  std::vector<PairRule> rules;
  std::vector<PartId> parts;          ///< Checked ones, in ascending order.
  std::vector<PairFinding> findings;  ///< For pairs within the threshold, in ascending order.
  std::vector<LeftOutPair> leftOut;   ///< Pairs whose boxes are within the threshold, in ascending order.

  /// All pairs of the parts, but those left out.
  std::size_t checkedPairs() const noexcept;
  /// Number of pairs with this verdict; all that were checked and are none of the others are Clear.
  std::size_t count(PairVerdict verdict) const noexcept;
  std::size_t forbidden() const noexcept;
};

/// The problem in a few words: "a mesh is not closed"; "" for None.
const char* textOf(VolumeProblem problem) noexcept;

/// Checks each pair of parts: by the exact predicates if they overlap, by distance if they are near. Of clashes it
/// measures curves, volume and depth.
///
/// Pairs of the same geometries at the same relative pose, to the bit, are computed once. The result does not depend on
/// the number of threads. Runs on all processors; builds missing hierarchies. Blocking. O(n log n) in the parts, besides
/// the pairs whose boxes are near.
/// Throws UsageError if the threshold or a rule is invalid, Cancelled.
SceneCheck checkScene(const SceneCheckRequest& request, const ProgressCallback& progress = {});

}  // namespace nearfit
