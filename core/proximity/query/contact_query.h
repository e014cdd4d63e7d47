#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/leaf_pair.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/motion_budget.h"

namespace nearfit {

/// Pair of features that may stop the part within a small step: a minimum, or nearly one.
struct ContactPair {
  glm::dvec3 point{0.0};      ///< On the part, in the frame of the scene's mesh [m].
  glm::dvec3 direction{0.0};  ///< Unit, from scene to part, in that frame.
  double distance = 0.0;      ///< [m]
};

/// Returns the max turn of the part in a step, by which conditions on directions are relaxed [rad]. It moves
/// the part's farthest points about as far as contacts count, so it does not limit the step. It is at most
/// one and a half degrees, since lists of pairs grow with it.
/// @param reach   Max distance of a contact [m].
/// @param radius  Radius of the part about its centre of mass [m].
double contactTurn(double reach, double radius) noexcept;

/// Max motion of a part in a step: how near contacts count, and how far the part may turn.
struct ContactReach {
  double distance = 0.0;  ///< [m]; > 0.
  double turn = 0.0;      ///< Angle by which conditions on directions are relaxed [rad].
};

/// Result of testContacts.
struct ContactResult {
  std::size_t count = 0;  ///< Number of filled entries of the caller's storage, in no order.
  /// Every contact among the pairs that is nearer than this is there [m]: the reach, or less if room ran out.
  double completeTo = 0.0;
  double least = 0.0;           ///< Min distance found [m]; infinity if none.
  std::uint64_t leafPairs = 0;  ///< Feature pairs tested.

  /// Lower bound on the distance of two bodies that do not overlap and are closed and oriented [m].
  double distanceBound() const noexcept { return least < completeTo ? least : completeTo; }
};

/// Number of feature pairs culled, or listed, in the time of opening one pair of nodes.
constexpr std::size_t kListedAtOnce = 8;

/// Result of findNearbyPairs.
struct NearbyPairs {
  std::size_t count = 0;    ///< Number of filled entries of the caller's storage.
  bool isComplete = false;  ///< False if room or work ran out, which ends the search at once.
  MotionBudget holds;       ///< Motion of the part within which no other pairs can be contacts.
  /// Work within the bound, in pairs of nodes: those opened, plus one per kListedAtOnce pairs culled or
  /// listed.
  std::uint64_t work = 0;
};

/// Finds the pairs of features that can be contacts at the query's pose, or at any pose within `slack` of it.
/// @param query    Its cutoff is not used.
/// @param maxWork  Bound on the work, in pairs of nodes; never exceeded.
/// Real-time safe. An invalid query gives no pairs.
NearbyPairs findNearbyPairs(const BodyPairQuery& query, const ContactReach& reach, const MotionBudget& slack,
                            LmdScratch& scratch, std::span<LeafPair> out, std::uint64_t maxWork) noexcept;

/// Finds the contacts among pairs of features: those that carry a minimum, or would if directions were
/// relaxed by `reach.turn`. They are all that can become minima while the part turns by that much, and
/// include the exact minima within the reach, but the points that span a flat region stand for it.
/// @param query   Its cutoff is not used.
/// @param pairs   From findNearbyPairs or a candidate list; all near pairs, so that no contact is missed.
/// @param out     Keeps the nearest if it fills; `completeTo` then says how far it is complete.
/// @param packed  Blocks of the first pairs (packEdgePairs()); may be empty.
/// Contacts are in the frame of the scene's mesh. Real-time safe.
ContactResult testContacts(const BodyPairQuery& query, const ContactReach& reach,
                           std::span<const LeafPair> pairs, std::span<ContactPair> out,
                           const PackedEdgePairs& packed = {}) noexcept;

}  // namespace nearfit
