#include "core/placing/drop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/placing/joint_set.h"
#include "core/placing/straight_contact.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUsualGap = 1e-6;   ///< [m]
constexpr double kGapOfSize = 1e-5;  ///< Fraction of the size of a part smaller than 0.1 m.
/// Share of the gap that must be left between the surfaces: where they meet at a slant, the gap along the direction is
/// wider. Also counts the rounding of distances in.
constexpr double kDistanceOfGap = 0.1;
/// A travel below this fraction of the gap is rounding: the parts already stand a gap away.
constexpr double kNoWay = 1e-3;

struct Pair {
  const Part *moving, *fixed;
};

RigidTransform fixedFromMoving(const Pair& pair, const glm::dvec3& shift) {
  RigidTransform moved = pair.moving->worldFromPart;
  moved.translation += shift;
  return (pair.fixed->worldFromPart.inverse() * moved).normalized();
}

/// True if spheres around the bounding boxes meet: cheap, and true whenever the bodies meet.
bool mayMeet(const Pair& pair, const glm::dvec3& shift) {
  const TriangleMesh &a = pair.moving->geometry->mesh, &b = pair.fixed->geometry->mesh;
  const glm::dvec3 centreInMoving = 0.5 * (a.bounds().lower + a.bounds().upper);
  const glm::dvec3 centre = fixedFromMoving(pair, shift).applyToPoint(centreInMoving);
  const double reach = 0.5 * (a.bounds().diagonal() + b.bounds().diagonal());
  return glm::distance(centre, 0.5 * (b.bounds().lower + b.bounds().upper)) <= 1.001 * reach;
}

bool doMeet(const Pair& pair, const glm::dvec3& shift) {
  if (!mayMeet(pair, shift)) return false;
  const PartGeometry &a = *pair.fixed->geometry, &b = *pair.moving->geometry;
  return findInterference(a.tree(), b.tree(), fixedFromMoving(pair, shift)).kind !=
         InterferenceKind::Disjoint;
}

/// True if bodies that do not meet stand so near that a part taken in hand there would not be told from one that touches:
/// flats of the meshes that are searched deviate from the files' (NormalConeTree::deviation()).
bool isTooNear(const Pair& pair, const glm::dvec3& shift, double gap, LmdScratch& scratch) {
  constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();
  if (!mayMeet(pair, shift)) return false;
  const NormalConeTree &a = pair.fixed->geometry->tree(), &b = pair.moving->geometry->tree();
  const double least = a.deviation() + b.deviation() + kDistanceOfGap * gap;
  const SurfaceDistance found =
      leastSurfaceDistance(a, b, fixedFromMoving(pair, shift), 2.0 * least, scratch, kUnbounded);
  return found.lowerBound < least;
}

const Part& movablePart(const Scene& scene, PartId id) {
  const Part* part = scene.find(id);
  if (part == nullptr) throw UsageError("part", "there is no such part", "choose a part of the scene");
  if (scene.isLocked(*part))
    throw UsageError(part->name, "the part is locked", "unlock it, or its group, first");
  return *part;
}

std::vector<Pair> pairsOf(const Scene& scene, std::span<const PartId> moved) {
  std::vector<Pair> pairs;
  for (const PartId id : moved) {
    const Part& moving = movablePart(scene, id);
    if (moving.geometry == nullptr) continue;
    for (const Scene::PartPtr& other : scene.parts()) {
      const bool isMoved = std::find(moved.begin(), moved.end(), other->id) != moved.end();
      if (!isMoved && other->isVisible && other->geometry != nullptr) pairs.push_back({&moving, other.get()});
    }
  }
  return pairs;
}

/// A direction of which joints leave less than this share is held by them.
constexpr double kLeastFreeShare = 1e-3;

/// The part of a unit direction that the joints of a part moved by itself allow; unit.
glm::dvec3 allowedDirection(const Scene& scene, std::span<const PartId> moved, const glm::dvec3& direction) {
  if (moved.size() != 1) return direction;
  const JointSet joints = jointsOf(scene, moved.front());
  if (joints.isEmpty()) return direction;
  const glm::dvec3 allowed = joints.freeShift(direction);
  if (glm::length(allowed) > kLeastFreeShare) return glm::normalize(allowed);
  throw UsageError(scene.get(moved.front()).name, "its joints hold it against this direction",
                   "choose another direction, or turn a joint off");
}

double gapOf(const DropOptions& options, const std::vector<Pair>& pairs) {
  if (options.gap != 0.0) return options.gap;
  double size = kInfinity;
  for (const Pair& pair : pairs)
    size = std::min(size, pair.moving->geometry->mesh.bounds().diagonal());
  return dropGap(size);
}

/// Reports the fraction of pairs done; also called in the middle of a pair, to allow cancelling.
class Steps {
 public:
  Steps(const ProgressCallback& progress, std::size_t count) : progress_(progress), count_(count) {}
  void report() const {
    const double fraction = count_ == 0 ? 1.0 : static_cast<double>(done_) / static_cast<double>(count_);
    if (progress_ && !progress_(std::min(fraction, 1.0))) throw Cancelled();
  }
  void finishOne() {
    ++done_;
    report();
  }

 private:
  const ProgressCallback& progress_;
  std::size_t count_, done_ = 0;
};

/// Stores the first contact of all pairs in the result; infinite travel if there is none.
void findFirst(const std::vector<Pair>& pairs, const glm::dvec3& direction, Steps& steps,
               DropResult& result) {
  result.travel = kInfinity;
  for (const Pair& pair : pairs) {
    const RigidTransform& worldFromFixed = pair.fixed->worldFromPart;
    const glm::dvec3 along = worldFromFixed.inverse().applyToVector(direction);
    const StraightContact contact = findStraightContact(
        pair.fixed->geometry->tree(), pair.moving->geometry->tree(), fixedFromMoving(pair, glm::dvec3(0.0)),
        glm::normalize(along), result.travel, [&steps] { steps.report(); });
    steps.finishOne();
    if (!contact.isFound) continue;
    result.travel = contact.travel;
    result.normal = worldFromFixed.applyToVector(contact.normal);
    result.moved = pair.moving->id;
    result.against = pair.fixed->id;
  }
}

/// Moves back from contact until no two bodies meet or are too near to be felt.
void stepBack(const std::vector<Pair>& pairs, const glm::dvec3& direction, double gap, DropResult& result) {
  const double contact = result.travel;
  LmdScratch scratch;
  for (double back = gap;; back *= 2.0) {
    const double travel = contact - back;
    result.travel = travel > kNoWay * gap ? travel : 0.0;
    result.shift = result.travel * direction;
    result.gap = contact - result.travel;
    // Nothing meets at the start, as checked before.
    if (result.travel == 0.0) return;
    const auto isInTheWay = [&](const Pair& pair) {
      if (doMeet(pair, result.shift)) return true;
      if (!isTooNear(pair, result.shift, gap, scratch)) return false;
      // Going back does not lead away from what stood so near at the start, beside the way.
      const bool isBeside = pair.moving->id != result.moved || pair.fixed->id != result.against;
      return !isBeside || !isTooNear(pair, glm::dvec3(0.0), gap, scratch);
    };
    if (std::none_of(pairs.begin(), pairs.end(), isInTheWay)) return;
  }
}

}  // namespace

double dropGap(double size) noexcept {
  return std::min(kUsualGap, kGapOfSize * size);
}

DropResult dropParts(const Scene& scene, std::span<const PartId> moved, const DropOptions& options,
                     const ProgressCallback& progress) {
  const double length = glm::length(options.direction);
  if (!(length > 0.0) || !std::isfinite(length))
    throw UsageError("direction", "it is zero or not finite", "give a finite direction other than zero");
  if (!(options.gap >= 0.0) || !std::isfinite(options.gap))
    throw UsageError("gap", "it is negative or not finite", "give 0 or more metres");
  const std::vector<Pair> pairs = pairsOf(scene, moved);
  const glm::dvec3 direction = allowedDirection(scene, moved, options.direction / length);
  Steps steps(progress, 2 * pairs.size());
  DropResult result;
  for (const Pair& pair : pairs) {
    if (doMeet(pair, glm::dvec3(0.0))) {
      result.outcome = DropResult::Outcome::Overlapping;
      result.moved = pair.moving->id;
      result.against = pair.fixed->id;
      return result;
    }
    steps.finishOne();
  }
  findFirst(pairs, direction, steps, result);
  if (!(result.travel < kInfinity)) {
    result.travel = 0.0;
    return result;
  }
  result.outcome = DropResult::Outcome::Contact;
  stepBack(pairs, direction, gapOf(options, pairs), result);
  return result;
}

}  // namespace nearfit
