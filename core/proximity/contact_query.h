#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/proximity/edge_pairs.h"
#include "core/proximity/leaf_pair.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/motion_budget.h"

namespace nearfit {

/// A pair of features that may come to hold the part within a small step: a minimum, or nearly one.
struct ContactPair {
  glm::dvec3 point{0.0};      ///< On the part [m].
  glm::dvec3 direction{0.0};  ///< From scene to part, unit.
  double distance = 0.0;      ///< [m]
};

/// What a part may turn in a step, and conditions on directions are relaxed by: what takes its farthest
/// points about as far as contacts count, so that a step by that is no bound, and at most a degree and a
/// half, since lists of pairs grow with it.
/// @param reach   How far away contacts count [m].
/// @param radius  Of the part about its centre of mass [m].
double contactTurn(double reach, double radius) noexcept;

/// What a part may do in a step: how far from where it is contacts count, and how far it may turn.
struct ContactReach {
  double distance = 0.0;  ///< [m]; > 0.
  double turn = 0.0;      ///< By which the conditions on directions are relaxed [rad].
};

struct ContactResult {
  std::size_t count = 0;  ///< Entries of the caller's storage that were filled, in no order.
  /// Every contact among the pairs that is nearer than this is there [m]: the reach, or less when there was
  /// no room.
  double completeTo = 0.0;
  double least = 0.0;  ///< The least distance that was found [m]; infinity when none.
  std::uint64_t leafPairs = 0;

  /// A bound below the distance of two bodies that do not overlap and are closed and oriented.
  double distanceBound() const noexcept { return least < completeTo ? least : completeTo; }
};

/// Whether two leaves can be a contact: regions are there as the points that span them.
bool spansContact(std::uint32_t sceneLeaf, std::uint32_t partLeaf) noexcept;

/// So many pairs of features are culled, or listed, in the time of one pair of nodes.
constexpr std::size_t kListedAtOnce = 8;

/// Pairs that were found to be near.
struct NearbyPairs {
  std::size_t count = 0;    ///< Entries of the caller's storage that were filled.
  bool isComplete = false;  ///< False when there was no room, or too much work: it is then left off at once.
  MotionBudget holds;       ///< Motion of the part for which they are all that can be contacts.
  /// In pairs of nodes: those opened, and one for each kListedAtOnce that are culled or listed. Never beyond
  /// the bound.
  std::uint64_t work = 0;
};

/// The pairs of features that can be contacts at the query's pose or at any other within `slack` of it.
/// @param query    Its cutoff is not used.
/// @param maxWork  Bound on the work, never passed.
/// Real-time safe.
NearbyPairs findNearbyPairs(const BodyPairQuery& query, const ContactReach& reach, const MotionBudget& slack,
                            LmdScratch& scratch, std::span<LeafPair> out, std::uint64_t maxWork) noexcept;

/// Pairs of a vertex, edge or face that carry a minimum or would if directions were relaxed by `reach.turn`:
/// everything that can become one while the part turns by so much. The exact minima within the reach are
/// among them, but flat regions are there as the points that span them.
/// @param query  Its cutoff is not used.
/// @param pairs   From findNearbyPairs, or a list: all that are near, so that none is missing.
/// @param out     Keeps the nearest if it fills; `completeTo` tells.
/// @param packed  What packEdgePairs made of the first pairs; none may be.
/// In the frame of the scene's mesh. Real-time safe.
ContactResult testContacts(const BodyPairQuery& query, const ContactReach& reach,
                           std::span<const LeafPair> pairs, std::span<ContactPair> out,
                           const PackedEdgePairs& packed = {}) noexcept;

}  // namespace nearfit
