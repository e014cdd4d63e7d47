#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/sampled_surface.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Max number of samples of one map, all surfaces together: some ten seconds of one processor and 200 MB.
constexpr std::size_t kMaxMapSamples = 2'000'000;

/// Surfaces no farther apart, or no deeper in each other, count as in contact [m]: what rounding in files and poses
/// comes to, as for touchTolerance().
constexpr double kContactDistance = 1e-6;

/// A part where it is measured.
struct MeasuredPart {
  PartId id{};
  PartGeometryPtr geometry;  ///< Not null.
  RigidTransform worldFromPart;
};

/// Subject, scene and range of a map.
struct ClearanceMapRequest {
  /// Among `parts`: one part, or several that move as one and are not measured against each other.
  std::vector<PartId> subject;
  std::vector<MeasuredPart> parts;  ///< The subject, and those that it is measured against.
  /// Max distance [m]; 0: one and a half times the median distance of the surface that is within automaticRange() and not
  /// in contact, no less than a hundredth of it or one and a half times the least distance, and rounded up like it.
  double range = 0.0;
  double keptRange = 0.0;     ///< Last automatic range [m], kept while it still suits; 0: none.
  bool hasNearParts = false;  ///< Map the surfaces of near parts too.
  bool isParallel = true;     ///< Use all processors; false: only the calling thread.
  std::size_t maxSamples = kMaxMapSamples;
};

/// Parts to map for a selection: what is in hand if nothing is selected, or all of it and nothing else; otherwise the part
/// selected last. Only parts with a surface, and of several the visible ones; empty if there are none.
std::vector<PartId> mapSubject(const Scene& scene, const std::vector<PartId>& selected);

/// The visible parts of a scene that have a surface, and the subject, visible or not.
/// Throws UsageError if there is no such part, it has no surface, or the range is not finite or below 0.
ClearanceMapRequest clearanceMapRequest(const Scene& scene, PartId subject, double range, bool hasNearParts);
/// The same for parts that move as one, of which the visible ones count.
ClearanceMapRequest clearanceMapRequest(const Scene& scene, const std::vector<PartId>& subject, double range,
                                        bool hasNearParts);

/// A surface with the clearance at each of its samples. In the part's frame.
struct MappedSurface {
  PartId part{};
  RigidTransform worldFromPart;  ///< Where it was measured.
  std::shared_ptr<const SampledSurface> surface;
  /// Distance to the nearest surface [m]; inside another part minus the depth below its surface. NaN: none within the
  /// range.
  std::vector<double> distances;
  std::vector<PartId> nearest;            ///< Part of that surface; PartId{} where there is none.
  std::vector<glm::dvec3> nearestPoints;  ///< Nearest point of that surface, in the world [m].
};

/// Clearance over the surface of a part, and of what is near.
struct ClearanceMap {
  double range = 0.0;  ///< [m]
  /// Exact distance between the surfaces of the subject and the nearest other part [m]: 0 if they meet, infinity if none
  /// is within the range. Samples alone may miss it.
  double leastDistance = std::numeric_limits<double>::infinity();
  /// The subject's first, then near parts in the order of the request.
  std::vector<MappedSurface> surfaces;
  std::size_t subjectCount = 1;  ///< Number of surfaces that are the subject's.
  bool isCoarse = false;         ///< Sampled more coarsely than wanted, by the max number of samples.

  std::size_t samples() const noexcept;
  std::span<const MappedSurface> subject() const noexcept { return std::span(surfaces).first(subjectCount); }
  /// The surface of a part; null if it is not in the map.
  const MappedSurface* find(PartId part) const noexcept;
};

/// Maps clearances. Keeps what is derived from meshes from one map to the next, as long as the meshes exist.
/// Thread-safe.
class ClearanceMapper {
 public:
  /// Computes the distance at each sample of the subject to the nearest part that is not of it, and at each sample of a
  /// near part to the subject: these show where the subject comes near, not how they touch each other.
  ///
  /// Distances are those of the hierarchies' meshes, to some roundings of the coordinates. Inside is what the closed
  /// components of a part enclose, decided exactly; depths are not limited by the range. A near part with no sample
  /// within the range is left out. Samples are the vertices, and points between them, no farther apart than
  /// sampleSpacing(); with more than `maxSamples`, farther. The result does not depend on the number of threads.
  /// Blocking; builds missing hierarchies. Throws UsageError like clearanceMapRequest(); Cancelled.
  ClearanceMap map(const ClearanceMapRequest& request, const ProgressCallback& progress = {});

 private:
  class Target;
  struct Sampled {
    std::weak_ptr<const PartGeometry> geometry;
    double spacing = 0.0;
    std::size_t maxSamples = 0;
    std::shared_ptr<const SampledSurface> surface;
  };
  struct Kept {
    std::weak_ptr<const PartGeometry> geometry;
    std::shared_ptr<const Target> target;
  };

  std::shared_ptr<const Target> targetOf(const PartGeometryPtr& geometry);
  std::shared_ptr<const SampledSurface> subjectSurface(const PartGeometryPtr& geometry, double spacing,
                                                       std::size_t maxSamples,
                                                       const ProgressCallback& progress);
  /// Forgets the sampling of all but these.
  void keepSamples(std::span<const MeasuredPart* const> subject);

  std::mutex mutex_;
  std::map<const PartGeometry*, Kept> targets_;
  /// Sampling of the last subject, by its meshes: it does not depend on poses.
  std::map<const PartGeometry*, Sampled> sampled_;
};

/// Spacing of samples for a range and the subject's diagonal [m]: an eighth of the range, but no less than a 200th and
/// no more than a 20th of the part.
double sampleSpacing(double range, double size) noexcept;

/// Range in which the distances of an automatic map are searched, for a subject at its least distance to other parts
/// [m]: a 20th of its diagonal or one and a half times that distance, whichever is more, rounded up to 1, 2 or 5 times a
/// power of ten.
/// @param kept  Returned instead if it is neither less nor more than four times as much; 0: none.
double automaticRange(double size, double leastDistance, double kept = 0.0) noexcept;

/// Clearance of a mapped surface at a point, interpolated between samples.
/// @param triangle  Of the part's mesh.
/// @param point     On that triangle, in the part's frame [m].
/// Nullopt where a sample around it has none within the range.
std::optional<double> clearanceAt(const MappedSurface& mapped, std::uint32_t triangle,
                                  const glm::dvec3& point);

}  // namespace nearfit
