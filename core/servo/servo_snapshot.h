#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/haptics/haptic_settings.h"
#include "core/haptics/spring_bound.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/scene/joint_set.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Why the servo stopped rendering.
enum class ServoFault : std::uint8_t {
  None,
  PoseNotFinite,      ///< A pose of handle or part is not finite, or its rotation is far from unit length.
  WrenchNotFinite,    ///< Overflow or NaN in springs or coupling.
  ParametersInvalid,  ///< Settings, limits or period are not finite or out of range.
};

/// Cause and remedy, as a sentence without a full stop; empty for None. Never null.
const char* faultReason(ServoFault fault) noexcept;

/// A minimum, in world coordinates, and the parts that it is between.
struct SnapshotLmd {
  Lmd lmd;
  PartId other{};
  PartId part{};  ///< The moving part, or the part of the moving group whose feature it is.
};

/// A contact where the proxy presses on another part; world coordinates.
struct SnapshotContact {
  glm::dvec3 point{0.0};      ///< On the moving part [m].
  glm::dvec3 direction{0.0};  ///< From the other part to the moving one; unit.
  double force = 0.0;         ///< Its share of the force on the hand, along `direction` [N].
  PartId other{};
  /// The moving part, or the part of the moving group that the point is on; of parts whose boxes overlap there, the one
  /// with the nearest minimum that is shown.
  PartId part{};
};

/// One tick as others see it; trivially copyable. Everything is in the world frame unless stated otherwise.
/// Counters that continue from tick to tick, here and beside the servo, have 64 bits and never wrap.
struct ServoSnapshot {
  static constexpr std::size_t kMaxLmds = 512;
  static constexpr std::size_t kMaxContacts = 16, kMaxOverlapping = 8;

  std::uint64_t tick = 0;  ///< Ticks run, including this one; 0 before the first.
  double time = 0.0;       ///< Since the servo started [s].
  RigidTransform handle;   ///< worldFromHandle: where the device wants the part.
  RigidTransform proxy;    ///< worldFromPart: where the part is; equal to `handle` with springs.
  Wrench wrench;           ///< On the handle, about the centre of mass, as rendered: within all limits.
  Wrench unclampedWrench;  ///< The same before limits, ramps and fading.
  Wrench guidance;         ///< Part of the unclamped wrench that pulls to the guidance's path.
  Wrench deviceWrench;     ///< `wrench` as the device is to render it, in the device's frame.
  glm::dvec3 centre{0.0};  ///< The part's centre of mass [m].
  double distance = 0.0;   ///< Min distance [m]; infinity if nothing is within the cutoff.
  double queryTime = 0.0, tickTime = 0.0;  ///< Time of the queries, and of the whole tick [s].
  /// Pairs of nodes and of features visited, listed and merged. Bounds the tick even when a busy machine
  /// stretches its time.
  std::uint64_t work = 0;
  std::uint32_t lmdCount = 0;    ///< All minima found within the cutoff, even those not in `lmds`.
  std::uint32_t areaCount = 0;   ///< Those of them that are not merged by area of contact.
  std::uint32_t storedLmds = 0;  ///< Entries of `lmds` in use, nearest first for each part.
  /// Bodies searched anew in this tick, since what is known of them did not cover the pose.
  std::uint32_t lateBodies = 0;
  bool isTruncated = false;      ///< Minima within the cutoff may be missing.
  bool isDistanceBound = false;  ///< `distance` is a lower bound: a missing minimum may be the nearest.
  bool isClamped = false;        ///< The wrench was limited to the device's max.
  bool isClutched = false;       ///< The hand repositions the device; the part stays.
  std::optional<double> grip{};  ///< HandleInput::grip [rad].
  ServoFault fault = ServoFault::None;  ///< Latched: the wrench is zero until the servo is restarted.
  PartId moving{};                      ///< The moving part; of a group the part that leads.

  HapticMode mode = HapticMode::Proxy;
  double period = 0.0;  ///< Measured period that the coupling is computed with [s].
  /// The coupling in force. Proxy mode only, like everything below except the energy and what overlaps.
  CouplingState coupling;
  /// Parts of the springs' wrench that the device's bound lets through (boundedSprings()). Springs mode only.
  SpringShares springShares;
  double energyToHand = 0.0;          ///< Net work done on the hand since the start [J].
  double proxyTime = 0.0;             ///< Time of the proxy without its queries [s].
  double wrenchTime = 0.0;            ///< Time until the wrench was known [s].
  std::uint32_t subSteps = 0;         ///< Steps that the proxy took in this tick.
  std::uint32_t shortenedSteps = 0;   ///< Steps shortened so that nothing is met on the way.
  std::uint32_t refusedSteps = 0;     ///< Steps not taken at all, for the same reason.
  std::uint32_t constraintCount = 0;  ///< Rows of the last step's program.
  std::uint32_t contactCount = 0;     ///< Contacts that hold the part.
  std::uint32_t storedContacts = 0;   ///< Entries of `contacts` in use.
  /// Parts that overlap the moving one; `overlapping` holds the first. The proxy does not feel them until they separate.
  std::uint32_t overlappingCount = 0;
  /// Springs mode only: the part may have entered others since it was last known what it overlaps. Then no distance
  /// between surfaces is known to be one between solids.
  bool isOverlapUnknown = false;
  /// The proxy waits, for a few ticks, until it is known what it overlaps.
  bool isWaiting = false;
  bool isStarved = false;  ///< Known contacts did not reach where the proxy would go.
  bool isBehind = false;   ///< The tick's work ended before the proxy's way.
  bool isCrowded = false;  ///< ContactFinder::isCrowded() of the proxy.
  /// The part's joints contradict each other, so that none holds it.
  bool areJointsContradictory = false;
  std::uint32_t jointCount = 0;  ///< Joints that hold the part.
  JointResidual offJoints;       ///< How far the part is off them, as a contact may hold it.
  std::array<SnapshotContact, kMaxContacts> contacts{};
  std::array<PartId, kMaxOverlapping> overlapping{};
  std::array<SnapshotLmd, kMaxLmds> lmds{};
};

}  // namespace nearfit
