// Everything that asks two small meshes how they stand to each other, at any pose. For what the accuracy
// statement promises, the answers are held against exact arithmetic; beyond it they must be numbers and
// within bounds.
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/overlap/interference.h"
#include "core/proximity/query/blocked_minima.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/surface/surface_contacts.h"
#include "core/proximity/surface/surface_distance.h"
#include "core/proximity/surface/unsided_surface.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/exact/exact_comparison.h"
#include "tests/exact/exact_meeting.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/small_mesh.h"
#include "tests/support/triangle_tests.h"

namespace nearfit::fuzz {
namespace {

constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kRoom = 1024;
/// Reported distances and points are as good as this, as a fraction of the size, and of coordinates: as
/// resources/docs/accuracy.md has it, with the sizes of both bodies and the way between them counted.
constexpr double kAgreement = 2e-11;

struct Case {
  const TriangleMesh &sceneMesh, &partMesh;
  const NormalConeTree &scene, &part;
  RigidTransform pose;
  double cutoff;
  bool isPromised;
  LmdScratch& scratch;

  BodyPairQuery query() const { return {scene, part, pose, cutoff}; }
  double tolerance() const {
    return kAgreement * (scene.size() + part.size()) +
           1e-15 * (glm::length(scene.centre()) + glm::length(part.centre()) + glm::length(pose.translation));
  }
};

double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 e = b - a;
  const double s = glm::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0, 1.0);
  return glm::distance(p, a + s * e);
}

/// From a point to the vertex, the edge, or the plane and the inside of the face.
double distanceToFeature(const TriangleMesh& mesh, FeatureKind kind, std::uint32_t index,
                         const glm::dvec3& p) {
  const auto v = mesh.vertices();
  if (kind == FeatureKind::Vertex) return glm::distance(v[index], p);
  if (kind == FeatureKind::Edge)
    return distanceToSegment(p, v[mesh.edges()[index].v0], v[mesh.edges()[index].v1]);
  const Triangle& t = mesh.triangles()[index];
  const glm::dvec3 normal = glm::normalize(glm::cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]));
  double outside = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = v[t[k]], &b = v[t[(k + 1) % 3]];
    if (glm::dot(glm::cross(b - a, p - a), normal) < 0.0)
      outside = std::max(outside, distanceToSegment(p, a, b));
  }
  return std::max(std::abs(glm::dot(p - v[t[0]], normal)), outside);
}

std::size_t countOf(const TriangleMesh& mesh, FeatureKind kind) {
  return kind == FeatureKind::Vertex ? mesh.vertices().size()
         : kind == FeatureKind::Edge ? mesh.edges().size()
                                     : mesh.triangles().size();
}

void checkLmd(const Case& c, const Lmd& lmd) {
  require(isFinite(lmd.scenePoint) && isFinite(lmd.partPoint) && isFinite(lmd.direction),
          "points are finite");
  require(lmd.distance > 0.0 && lmd.distance <= c.cutoff, "a distance is above 0 and within the cutoff");
  require(std::abs(glm::length(lmd.direction) - 1.0) < 1e-9, "a direction is unit");
  require(lmd.sceneIndex < countOf(c.sceneMesh, lmd.sceneFeature) &&
              lmd.partIndex < countOf(c.partMesh, lmd.partFeature),
          "features exist");
  require(std::isfinite(lmd.extent.measure) && lmd.extent.measure >= 0.0 && isFinite(lmd.extent.axis) &&
              std::isfinite(lmd.extent.halfLength) && std::isfinite(lmd.extent.halfWidth) &&
              std::isfinite(lmd.extent.inside.x) && std::isfinite(lmd.extent.inside.y),
          "an extent is finite");
  if (!c.isPromised || lmd.isRegion) return;
  require(distanceToFeature(c.sceneMesh, lmd.sceneFeature, lmd.sceneIndex, lmd.scenePoint) <= c.tolerance(),
          "the scene's point lies on its feature");
  require(distanceToFeature(c.partMesh, lmd.partFeature, lmd.partIndex,
                            c.pose.inverse().applyToPoint(lmd.partPoint)) <= c.tolerance(),
          "the part's point lies on its feature");
}

/// Storage that is kept from input to input: what takes long under sanitizers is to come by memory.
template <class T, std::size_t kCount = kRoom>
std::vector<T>& kept() {
  static std::vector<T> room(kCount);
  return room;
}

std::vector<Lmd> checkCold(const Case& c) {
  std::vector<Lmd>& room = kept<Lmd>();
  const LmdResult result = findLmds(c.scene, c.part, c.pose, c.cutoff, c.scratch, room);
  require(result.count <= room.size(), "no more minima than room");
  const std::vector<Lmd> found(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(result.count));
  require(result.status == QueryStatus::Complete, "a small query is complete");
  for (std::size_t i = 0; i < found.size(); ++i) {
    checkLmd(c, found[i]);
    require(i == 0 || found[i - 1].distance <= found[i].distance, "the nearest stands first");
  }
  return found;
}

/// With little room and little work: what is said to be complete is.
void checkTruncated(const Case& c, const std::vector<Lmd>& all) {
  std::vector<Lmd> some(2);
  const LmdResult result = findNearestLmds(c.scene, c.part, c.pose, c.cutoff, c.scratch, some, 8);
  require(result.count <= some.size(), "no more minima than room");
  for (std::size_t i = 0; i < result.count; ++i)
    checkLmd(c, some[i]);
  if (!c.isPromised || result.count == 0 || result.completeTo <= 0.0 || all.empty()) return;
  require(some[0].distance <= all[0].distance + c.tolerance(), "of what is complete the nearest is there");
}

/// Those that are farther apart than rounding, in their order: whether there is a nearer one hangs on it.
std::vector<Lmd> apartMinima(const Case& c, std::span<const Lmd> minima) {
  std::vector<Lmd> apart;
  std::ranges::copy_if(minima, std::back_inserter(apart),
                       [&](const Lmd& m) { return m.distance > c.tolerance(); });
  return apart;
}

void checkTracked(const Case& c, ByteSource& bytes) {
  const double travel = std::abs(bytes.number()), turn = std::min(1.0, std::abs(bytes.number()));
  MotionRange range;
  range.budget = {std::isfinite(travel) ? travel : 0.1, std::isfinite(turn) ? turn : 0.1};
  static CandidateList list;
  list.build(c.query(), range, c.scratch);
  for (std::size_t i = 0; i < 3; ++i) {
    Case there = c;
    if (i > 0) {
      const glm::dvec3 way = bytes.vector(), axis = bytes.vector();
      if (!isFinite(way) || !isFinite(axis)) continue;
      const double share = 0.5 * range.budget.travel / (1.0 + glm::length(way));
      there.pose.translation += share * way;
      const double spin = 0.1 * range.budget.turn / (1.0 + glm::length(axis));
      there.pose.rotation =
          glm::normalize(glm::dquat(1.0, spin * axis.x, spin * axis.y, spin * axis.z) * there.pose.rotation);
      if (!isPose(there.pose)) continue;
    }
    if (!isPromised(c.sceneMesh, c.partMesh, there.pose)) continue;
    std::vector<Lmd>& room = kept<Lmd>();
    const auto result = list.query(there.pose, c.cutoff, c.scratch, room);
    if (!result) continue;
    const std::vector<Lmd> tracked = apartMinima(c, std::span(room).first(result->count));
    const std::vector<Lmd> cold = apartMinima(c, checkCold(there));
    require(tracked.size() == cold.size(), "tracked minima are as many as cold ones");
    for (std::size_t k = 0; k < cold.size(); ++k) {
      require(tracked[k].scenePoint == cold[k].scenePoint && tracked[k].partPoint == cold[k].partPoint,
              "tracked minima are the cold ones");
    }
  }
}

/// Contacts within `reach`, of pairs that were gathered with room for so much motion; `isAll` when no pair is
/// left out.
ContactResult contactsWith(const Case& c, const ContactReach& reach, const MotionBudget& slack,
                           std::vector<ContactPair>& contacts, bool& isAll) {
  std::vector<LeafPair>& pairs = kept<LeafPair, 1U << 14>();
  const NearbyPairs nearby = findNearbyPairs(c.query(), reach, slack, c.scratch, pairs, kUnbounded);
  require(nearby.count <= pairs.size(), "no more pairs than room");
  isAll = nearby.isComplete;
  const std::span<LeafPair> found = std::span(pairs).first(nearby.count);
  std::vector<EdgePairs>& blocks = kept<EdgePairs, (1U << 14) / EdgePairs::kLanes>();
  const std::size_t filled = std::min(edgePairsToFront(found) / EdgePairs::kLanes, blocks.size());
  for (std::size_t i = 0; i < filled; ++i)
    packEdgePairs(c.query().scene, c.query().part,
                  found.subspan(i * EdgePairs::kLanes).first<EdgePairs::kLanes>(),
                  edgePairKernels(defaultSimdLevel()), blocks[i]);
  const ContactResult result =
      testContacts(c.query(), reach, found, contacts,
                   {std::span(blocks).first(filled), edgePairKernels(defaultSimdLevel())});
  require(result.count <= contacts.size(), "no more contacts than room");
  return result;
}

/// Nearer than rounding a direction has no meaning, and whether there is a contact hangs on it.
std::ptrdiff_t apartContacts(const Case& c, std::span<const ContactPair> contacts) {
  return std::ranges::count_if(contacts, [&](const ContactPair& k) { return k.distance > c.tolerance(); });
}

void checkContacts(const Case& c, const std::vector<Lmd>& minima) {
  const ContactReach reach{c.cutoff, 0.02};
  std::vector<ContactPair>& contacts = kept<ContactPair>();
  bool isAll = false, isAllOfRoomy = false;
  const ContactResult result = contactsWith(c, reach, {}, contacts, isAll);
  for (std::size_t i = 0; i < result.count; ++i) {
    require(isFinite(contacts[i].point) && isFinite(contacts[i].direction), "contacts are finite");
    require(contacts[i].distance >= 0.0 && contacts[i].distance <= c.cutoff, "contacts are within reach");
  }
  const std::ptrdiff_t apart = apartContacts(c, std::span(contacts).first(result.count));
  const ContactResult roomy = contactsWith(c, reach, {0.01 * c.cutoff, 0.01}, contacts, isAllOfRoomy);
  if (!c.isPromised || !isAll) return;
  if (isAllOfRoomy) {
    require(apartContacts(c, std::span(contacts).first(roomy.count)) == apart,
            "room for motion changes no contact");
  }
  if (!minima.empty() && !minima[0].isRegion && minima[0].distance > c.tolerance()) {
    require(result.least <= minima[0].distance + c.tolerance(), "the nearest minimum is a contact");
  }
}

void checkSurfaces(const Case& c, const std::vector<Lmd>& minima) {
  const SurfaceDistance distance =
      leastSurfaceDistance(c.scene, c.part, c.pose, c.cutoff, c.scratch, kUnbounded);
  require(distance.lowerBound >= 0.0 && distance.lowerBound <= c.cutoff,
          "a lower bound is within its limits");
  if (distance.isFound) {
    require(isFinite(distance.scenePoint) && isFinite(distance.partPoint) && distance.distance >= 0.0,
            "the nearest points are finite");
    require(distance.lowerBound <= distance.distance, "a lower bound is below");
  }
  const UnsidedSurface scene(c.scene), part(c.part);
  std::vector<SurfaceContact>& contacts = kept<SurfaceContact>();
  std::vector<TrianglePair>& pairs = kept<TrianglePair, 1U << 14>();
  const NearbyTriangles nearby =
      findNearbyTriangles(scene, part, c.pose, c.cutoff, c.scratch, pairs, kUnbounded);
  require(nearby.count <= pairs.size(), "no more triangles than room");
  const SurfaceContacts result =
      test::testTriangles(scene, part, c.pose, c.cutoff,
                          {std::span(pairs).first(nearby.count), nearby.within, 0.0, 0.0}, contacts);
  require(result.count <= contacts.size(), "no more contacts than room");
  require(result.lowerBound >= 0.0 && result.lowerBound <= c.cutoff, "a lower bound is within its limits");
  for (std::size_t i = 0; i < result.count; ++i) {
    require(isFinite(contacts[i].scenePoint) && isFinite(contacts[i].partPoint), "contacts are finite");
    require(contacts[i].distance > 0.0 && contacts[i].distance <= c.cutoff, "contacts are within reach");
    require(std::abs(glm::length(contacts[i].direction) - 1.0) < 1e-9, "a direction is unit");
  }
  if (!c.isPromised || minima.empty()) return;
  require(distance.lowerBound <= minima[0].distance + c.tolerance(),
          "no minimum is below the least distance");
}

/// In exact arithmetic: what has no tolerance has none at any size.
void checkExactly(const Case& c) {
  const Interference found = findInterference(c.scene, c.part, c.pose);
  const bool doMeet = test::doSurfacesMeetExactly(c.sceneMesh, c.partMesh, c.pose);
  require((found.kind == InterferenceKind::SurfacesMeet) == doMeet, "surfaces meet where they do exactly");
  if (!c.isPromised) return;
  const double least = test::leastDistanceExactly(c.sceneMesh, c.partMesh, c.pose);
  const SurfaceDistance distance =
      leastSurfaceDistance(c.scene, c.part, c.pose, c.cutoff, c.scratch, kUnbounded);
  require(distance.lowerBound <= least * (1.0 + 1e-15), "the lower bound of distance is one");
  if (distance.isComplete && least < c.cutoff - c.tolerance()) {
    require(distance.isFound && std::abs(distance.distance - least) <= c.tolerance(),
            "the least distance is the exact one");
  }
  const test::BodyPair pair{"fuzz", c.sceneMesh, c.partMesh};
  test::ExactComparison(pair).checkPose(c.pose, c.cutoff);
}

/// Rational arithmetic takes many times as long as all else. A fuzzer has it for some inputs, whatever they
/// grew from; a replay, and one who makes a finding small, for all.
bool isHeldExactly([[maybe_unused]] std::span<const std::uint8_t> input) {
#ifdef NEARFIT_FUZZ
  constexpr std::uint64_t kShare = 32;
  static const bool isAlways = std::getenv("NEARFIT_FUZZ_EXACT") != nullptr;
  std::uint64_t hash = 0xCBF29CE484222325U;  // FNV-1a
  for (const std::uint8_t byte : input)
    hash = (hash ^ byte) * 0x100000001B3U;
  return isAlways || (hash >> 32U) % kShare == 0;
#else
  return true;
#endif
}

void run(ByteSource& bytes) {
  static LmdScratch scratch(kRoom);
  const bool isExact = isHeldExactly(bytes.rest());
  const double cutoff = bytes.number();
  const RigidTransform pose = smallPose(bytes);
  const RigidTransform odd = bytes.flag() ? bytes.anyPose() : pose;
  const auto scene = smallMesh(bytes), part = smallMesh(bytes);
  if (!scene || !part) return;
  const NormalConeTree sceneTree(*scene), partTree(*part);
  // Arguments that make no sense: nothing bad may come of them.
  std::vector<Lmd> some(16);
  const LmdResult result = findLmds(sceneTree, partTree, odd, cutoff, scratch, some);
  require(result.count <= some.size(), "no more minima than room");
  if (!(cutoff > 0.0) || !std::isnormal(cutoff)) {
    require(result.count == 0, "there is nothing within no cutoff");
    return;
  }
  const Case c{*scene, *part, sceneTree, partTree, pose, cutoff, isPromised(*scene, *part, pose), scratch};
  std::vector<Lmd> minima = checkCold(c);
  markBlocked(sceneTree, partTree, pose, minima, 0.0, scratch);
  checkTruncated(c, minima);
  if (c.isPromised) checkTracked(c, bytes);
  checkContacts(c, minima);
  checkSurfaces(c, minima);
  constexpr std::size_t kExactPairs = 150;
  if (isExact && scene->triangles().size() * part->triangles().size() <= kExactPairs) checkExactly(c);
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The comparison with exact arithmetic reports to GoogleTest, which here throws what nobody catches.
  GTEST_FLAG_SET(throw_on_failure, true);
  nearfit::fuzz::ByteSource bytes(data, size);
  nearfit::fuzz::run(bytes);
  return 0;
}
