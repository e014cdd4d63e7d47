#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/batch/minima_table.h"
#include "core/haptics/spring_law.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "core/parallel/work_spaces.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/tracking/lmd_set.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Max minima of one part at a pose, as of nearfit-cli lmd; bounds memory at some gigabytes.
constexpr std::size_t kMaxBatchMinima = 4'000'000;

/// How the poses of a batch are worked off. Results depend on none of it.
struct BatchOptions {
  bool isTracked =
      false;  ///< Follow the part from pose to pose, as the servo does. Only for minima and wrenches.
  std::size_t threads = 0;  ///< Max number of threads; 0: all processors.
  ProgressCallback progress = {};
};

/// A part of a scene, asked about at many poses: minima, distances, overlaps and wrenches against all other visible parts
/// that have a surface. World frame. Keeps the geometry, but does not follow changes of the scene.
///
/// Poses must be finite, with unit quaternions (checkedPose). Of a scene whose other part is where the world's origin is,
/// the results are those of nearfit-cli lmd to the last bit: the part's pose is not touched. Thread-safe.
class PartQueries {
 public:
  /// Builds missing hierarchies: blocking. Throws UsageError if there is no such part or it has no triangles, Cancelled.
  PartQueries(const Scene& scene, PartId part, const ProgressCallback& progress = {});

  /// Names of the other parts, in scene order.
  const std::vector<std::string>& otherNames() const noexcept { return *names_; }
  /// The same, for results that outlive this.
  std::shared_ptr<const std::vector<std::string>> sharedNames() const noexcept { return names_; }
  /// True if the meshes are so large that a pose may take long. Progress is then reported after each pose, else after some.
  bool arePosesSlow() const noexcept { return arePosesSlow_; }

  /// All minima within the cutoff.
  /// @param cutoff  [m]; finite, > 0.
  /// Throws UsageError if the cutoff is invalid, Cancelled.
  MinimaTable minima(std::span<const RigidTransform> poses, double cutoff, const BatchOptions& options = {});

  /// Min distance to any other part at each pose [m], as PairSeparation::distance; infinity if it is beyond `within`.
  /// @param within  [m]; > 0, may be infinite.
  /// Throws UsageError if `within` is invalid, Cancelled.
  std::vector<double> distances(std::span<const RigidTransform> poses,
                                double within = std::numeric_limits<double>::infinity(),
                                const BatchOptions& options = {});

  /// 1 for each pose at which the part has a point in common with another one, decided exactly (interference.h); else 0.
  /// Throws Cancelled.
  std::vector<std::uint8_t> overlaps(std::span<const RigidTransform> poses, const BatchOptions& options = {});

  /// Sum of the springs of all minima at each pose, at rest, about the part's centre of mass.
  /// Throws UsageError if a parameter is invalid; Error naming the pose if it has too many minima, or a force is too large
  /// for a number; Cancelled.
  std::vector<Wrench> wrenches(std::span<const RigidTransform> poses, const SpringParameters& springs,
                               const BatchOptions& options = {});

 private:
  /// Another part.
  struct Other {
    PartGeometryPtr geometry;
    std::shared_ptr<ComponentsOnDemand> components;
    RigidTransform worldFromOther;
    bool isAtOrigin;    ///< worldFromOther is the identity.
    glm::dvec3 centre;  ///< Of a sphere that holds it, in the world [m].
    double radius;      ///< [m]
  };
  struct FoundLmd {
    Lmd lmd;
    std::int32_t other;
  };
  /// Work space of a thread.
  struct Space {
    LmdCollector collector{kMaxBatchMinima};
    std::optional<LmdScratch> scratch;  ///< For distances, made when first needed: it is large.
    std::vector<FoundLmd> found;
    std::vector<Lmd> lmds;
  };
  /// Pairs that a stretch of poses follows, one for each other part.
  using FollowedPairs = std::vector<std::optional<FollowedPair>>;

  RigidTransform poseIn(const Other& other, const RigidTransform& worldFromPart) const noexcept;
  bool isFarther(const Other& other, const RigidTransform& worldFromPart, double distance) const noexcept;
  LmdSet setOf(std::size_t other, const RigidTransform& otherFromPart, double cutoff, Space& space,
               FollowedPairs* followed) const;
  /// Fills `space.found` with the minima at a pose. False if there are too many.
  bool findAt(const RigidTransform& pose, const SpringParameters& springs, Space& space,
              FollowedPairs* followed) const;
  double distanceAt(const RigidTransform& pose, double within, Space& space) const;
  bool overlapsAt(const RigidTransform& pose) const;
  Wrench wrenchOf(std::size_t index, const RigidTransform& pose, const SpringParameters& springs,
                  bool isWhole, Space& space) const;
  /// Calls work(begin, end, space, followed) for stretches of `count` poses or parts of them, on several threads. Those of
  /// one stretch come in order, in one thread.
  template <class Work>
  void forStretches(std::size_t count, const BatchOptions& options, const Work& work);

  PartGeometryPtr part_;
  std::shared_ptr<ComponentsOnDemand> partComponents_;
  glm::dvec3 partCentre_{0.0};  ///< Of a sphere that holds the part, in its frame [m].
  double partRadius_ = 0.0;     ///< [m]
  std::vector<Other> others_;
  std::shared_ptr<const std::vector<std::string>> names_;
  bool arePosesSlow_ = false;
  WorkSpaces<Space> spaces_;
};

}  // namespace nearfit
