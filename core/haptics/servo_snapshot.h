#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/haptics/haptic_settings.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/scene/scene.h"

namespace nearfit {

enum class ServoFault : std::uint8_t {
  None,
  PoseNotFinite,      ///< Of the handle or of a part; also a rotation far from unit length.
  WrenchNotFinite,    ///< Overflow or NaN in springs or coupling.
  ParametersInvalid,  ///< Settings, limits or period that are not finite or out of range.
};

/// What happened and what to do, as a sentence without a full stop; empty for None.
const char* faultReason(ServoFault fault) noexcept;

/// Which part a minimum belongs to; the rest is in world coordinates.
struct SnapshotLmd {
  Lmd lmd;
  PartId other{};
};

/// Where the proxy presses on another part; world coordinates.
struct SnapshotContact {
  glm::dvec3 point{0.0};      ///< On the moving part [m].
  glm::dvec3 direction{0.0};  ///< From the other part to the moving one; unit.
  double force = 0.0;         ///< Its share of the force that the hand feels, along `direction` [N].
  PartId other{};
};

/// One tick as others see it; trivially copyable. All in the world frame. Counters that go on from tick to
/// tick, here and beside the servo, have 64 bits: they never wrap.
struct ServoSnapshot {
  static constexpr std::size_t kMaxLmds = 512;
  static constexpr std::size_t kMaxContacts = 16, kMaxReleased = 8;

  std::uint64_t tick = 0;  ///< Ticks run so far with this one; 0 before the first.
  double time = 0.0;       ///< Since the servo started [s].
  RigidTransform handle;   ///< worldFromHandle: where the device wants the part's frame.
  RigidTransform proxy;    ///< worldFromPart: where the part is. In the direct mode the same.
  Wrench wrench;           ///< On the handle, about the centre of mass, as it is rendered: within all limits.
  Wrench unclampedWrench;  ///< As it would be without limits, ramps and fading.
  Wrench deviceWrench;     ///< `wrench` as the device is to render it, in the device's frame.
  glm::dvec3 centre{0.0};  ///< The part's centre of mass [m].
  double distance = 0.0;   ///< Least distance [m]; infinity when nothing is within the cutoff.
  double queryTime = 0.0, tickTime = 0.0;  ///< [s]
  /// Pairs of nodes and of features looked at, listed and merged: what bounds the tick where its time, on a
  /// busy machine, cannot.
  std::uint64_t work = 0;
  std::uint32_t lmdCount = 0;    ///< All minima within the cutoff, also those that are not in `lmds`.
  std::uint32_t storedLmds = 0;  ///< Entries of `lmds` in use, nearest first for each part.
  /// Bodies that were searched anew in this tick, as what is known of them did not cover the pose.
  std::uint32_t lateBodies = 0;
  bool isTruncated = false;
  bool isClamped = false;
  bool isClutched = false;              ///< The hand repositions the device: the part stays.
  ServoFault fault = ServoFault::None;  ///< Latched: the wrench is zero until the servo is started anew.
  PartId moving{};

  HapticMode mode = HapticMode::Proxy;
  double period = 0.0;                ///< Measured, that the coupling is reckoned with [s].
  CouplingState coupling;             ///< Proxy mode only, as all that follows but for the energy.
  double energyToHand = 0.0;          ///< Given to the hand since the start, less what came back [J].
  double proxyTime = 0.0;             ///< Of the tick, for the proxy without its queries [s].
  std::uint32_t subSteps = 0;         ///< Steps that the proxy took in this tick.
  std::uint32_t shortenedSteps = 0;   ///< Cut short, so that nothing is met on the way.
  std::uint32_t refusedSteps = 0;     ///< Not taken at all, for the same reason.
  std::uint32_t constraintCount = 0;  ///< Pairs of features in the last step's program.
  std::uint32_t contactCount = 0;     ///< Of them, those that hold the part.
  std::uint32_t storedContacts = 0;   ///< Entries of `contacts` in use.
  /// Parts that the moving one overlaps and so cannot feel until they are apart; `released` holds the first.
  std::uint32_t releasedCount = 0;
  /// The proxy waits, for a few ticks, until what it overlaps is known.
  bool isWaiting = false;
  bool isStarved = false;  ///< What is known of contacts did not reach where the proxy would go.
  std::array<SnapshotContact, kMaxContacts> contacts{};
  std::array<PartId, kMaxReleased> released{};
  std::array<SnapshotLmd, kMaxLmds> lmds{};
};

}  // namespace nearfit
