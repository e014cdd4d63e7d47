#include "core/proximity/query/contact_areas.h"

#include <array>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/segment_obstacle.h"

namespace nearfit {
namespace {

/// Places looked at, as parts of the way; the middle first, where the gap between separate contacts is widest.
constexpr std::array<double, 3> kAreaPlaces{0.5, 0.25, 0.75};

bool standsForAnArea(const Lmd& lmd, double cutoff) noexcept {
  return !lmd.isBlocked && !lmd.isMerged && lmd.distance < cutoff;
}

/// The gap between two bodies, in the scene's centred frame.
class Gap {
 public:
  Gap(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
      SegmentKernel kernel) noexcept
      : origin_(scene.centre()),
        partFromScene_(centredPose(scene, part, sceneFromPart).inverse()),
        scene_(scene, kernel, kSegmentTouch * (scene.size() + part.size())),
        part_(part, kernel, kSegmentTouch * (scene.size() + part.size())) {}

  /// Point in the middle of a minimum's segment.
  glm::dvec3 middleOf(const Lmd& lmd) const noexcept {
    return scenePointInside(lmd) - origin_ + 0.5 * lmd.distance * lmd.direction;
  }

  /// True if both surfaces lie within `reach` of a place, to either side along a unit direction.
  bool isWithin(const glm::dvec3& place, const glm::dvec3& direction, double reach) const noexcept {
    const SegmentStretch both{-reach, reach};
    return part_.blocks(partFromScene_.applyToPoint(place), partFromScene_.applyToVector(direction), both) &&
           scene_.blocks(place, direction, both);
  }

 private:
  glm::dvec3 origin_;
  RigidTransform partFromScene_;
  SegmentObstacle scene_, part_;
};

/// True if the gap stays narrow on the way between two minima whose directions agree.
/// @param farther  The one of the larger distance.   @param work  Work done is added.
bool isNarrowBetween(const Gap& gap, const Lmd& nearer, const Lmd& farther, double opening,
                     std::uint64_t& work) noexcept {
  const glm::dvec3 from = gap.middleOf(nearer), way = gap.middleOf(farther) - from;
  const glm::dvec3 turn = farther.direction - nearer.direction;
  // Of a curve with these normals at its ends: it leaves its chord by t (1 - t) / 2 times this. Along a bulge of the
  // scene the directions spread, and the curve lies on the outer side.
  const double bend = glm::dot(way, turn);
  const double reach = 0.5 * farther.distance + opening;
  for (const double t : kAreaPlaces) {
    work += kWorkOfGap;
    const glm::dvec3 direction = glm::normalize(nearer.direction + t * turn);
    const glm::dvec3 place = from + t * way + 0.5 * t * (1.0 - t) * bend * direction;
    if (!gap.isWithin(place, direction, reach)) return false;
  }
  return true;
}

}  // namespace

AreaResult mergeAreas(const NormalConeTree& scene, const NormalConeTree& part,
                      const RigidTransform& sceneFromPart, double cutoff, std::span<Lmd> lmds,
                      LmdScratch& scratch, std::uint64_t work) noexcept {
  AreaResult result;
  for (Lmd& lmd : lmds)
    lmd.isMerged = false;
  if (scene.isEmpty() || part.isEmpty() || !sceneFromPart.isFinite()) return result;
  const Gap gap(scene, part, sceneFromPart, scratch.data().segmentCull);
  const double opening = kAreaOpening * cutoff;
  std::uint64_t comparisons = 0, looks = 0;
  const auto spent = [&] { return looks + comparisons / kAreaComparisonsOfWork; };
  for (std::size_t j = 0; j < lmds.size(); ++j) {
    Lmd& lmd = lmds[j];
    if (!standsForAnArea(lmd, cutoff)) continue;
    for (std::size_t i = 0; i < j && !lmd.isMerged; ++i) {
      if (spent() >= work) {
        result.isComplete = false;
        break;
      }
      ++comparisons;
      const Lmd& nearer = lmds[i];
      if (!standsForAnArea(nearer, cutoff) || glm::dot(nearer.direction, lmd.direction) < kAreaCosine)
        continue;
      lmd.isMerged = isNarrowBetween(gap, nearer, lmd, opening, looks);
    }
    result.areas += lmd.isMerged ? 0 : 1;
  }
  result.work = spent();
  return result;
}

}  // namespace nearfit
