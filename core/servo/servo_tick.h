#pragma once

#include <cstdint>

#include "core/haptics/device_limits.h"
#include "core/haptics/free_motion.h"
#include "core/haptics/guidance.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/passivity_controller.h"
#include "core/haptics/period_meter.h"
#include "core/haptics/spring_bound.h"
#include "core/haptics/workspace_mapper.h"
#include "core/haptics/wrench_conditioner.h"
#include "core/servo/minima_finder.h"
#include "core/servo/proxy.h"
#include "core/servo/servo_snapshot.h"
#include "core/servo/shown_reach.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Settings and device limits of a tick.
struct ServoParameters {
  HapticSettings haptics;
  DeviceLimits limits;  ///< Of the device itself: not scaled by limitsAtHandle().
};

/// One servo tick: the device's pose in, wrench and snapshot out. Depends only on its inputs and the ticks
/// before. It owns no thread and no device, and reads the clock only to measure times.
///
/// A device that senses turning but renders no torque (HandleInput::isTorqueFelt) gets none, and the proxy turns as
/// freely as it can (kTurnScaleWithoutTorque), so that a torque which cannot be shown does not become a force.
///
/// The device's pose becomes the handle's (WorkspaceMapper). In the proxy mode the part follows the handle as
/// far as it can (Proxy), and the hand feels the coupling between the two. In the springs mode the part is
/// where the handle is, and the hand feels the sum of the springs, as far as the device bears it (boundedSprings()). The
/// wrench is kept passive (PassivityController) and within the device's limits (limitedCoupling(), WrenchConditioner). When
/// the mode changes, the handle returns to the part and the force ramps up from zero: the handle may be where only the
/// other mode lets the part go. In either mode the hand also feels the scene's guidance (GuidanceFollower), if there is one.
///
/// A tick has two halves: feel() computes what the hand waits for, show() the rest, when the wrench is on its way.
/// In the proxy mode the wrench does not wait for geometry: feel() lets the part follow for as much as
/// kWorkOfFeel, and takes the wrench from the constraints known by then (Proxy::feltPose()); show() lets it follow
/// on and finds the minima. What is shown and recorded is the pose that is proved free.
///
/// No tick does more than mostWork() (work_bound.h). In the proxy mode, where no force depends on minima,
/// their cutoff is shortened while they take more time than there is (a nut on its thread has thousands), and
/// the snapshot says truncated.
class ServoTick {
 public:
  /// Time constant of the velocity filter [s]: long enough to smooth encoder steps, short enough (80 Hz) that
  /// damping still damps.
  static constexpr double kVelocityTimeConstant = 2e-3;

  ServoTick() = default;

  /// Forgets velocities, energies, the proxy and the fault, as if it had never run. Real-time safe.
  void reset() noexcept;

  /// Work of the proxy that the wrench waits for: some 10 us. A part near some hundred pairs of features ends
  /// its way within it. Among thousands of pairs the wrench waits for nothing.
  static constexpr std::uint64_t kWorkOfFeel = 256;
  /// Energy that what was felt ahead of the part may give the hand by coming back: at once [J], and with time [W]. A
  /// part that was far behind finds a wall between itself and the hand, and its full push at once would be energy that
  /// nobody put in. The first holds 5 mm at 1.6 N/mm.
  static constexpr double kMaxReturnEnergy = 0.02, kReturnPower = 0.02;

  /// Computes the wrench and what it comes from; `wrench`, `deviceWrench` and `handle` are then final. show()
  /// must follow before the next feel().
  ///
  /// Velocities, for damping, are pose differences through a first-order low-pass of `kVelocityTimeConstant`.
  /// NaN, infinity or an invalid parameter anywhere gives a zero wrench, leaves the part where it was and
  /// latches the fault until reset().
  ///
  /// @param tracked   What to feel; must stay alive and unchanged until show() has returned. Where it does
  ///                  not cover the pose, the tick searches for itself, within a bound (`lateBodies`).
  /// @param input     From the device; its quaternion is normalised.
  /// @param period    Time since the last tick [s]; > 0.
  /// Real-time safe.
  void feel(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
            double period, ServoSnapshot& snapshot) noexcept;

  /// Moves the part on and completes the snapshot of feel(): pose of the part, minima, min distance, contacts,
  /// parts that are not felt. Does nothing in the springs mode, where feel() has filled it.
  ///
  /// @param snapshot  As feel() left it. Complete afterwards, except for `tick`, `time` and `tickTime`, which
  ///                  the caller sets.
  /// An invalid pose of a body that came near in this tick faults from the next tick on. Real-time safe.
  void show(const TrackedScene& tracked, const ServoParameters& parameters, ServoSnapshot& snapshot) noexcept;

  /// Calls feel() and show(), for callers with no device to answer in between. Real-time safe.
  void run(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
           double period, ServoSnapshot& snapshot) noexcept;

 private:
  /// Context that both halves share.
  struct Subject {
    const TrackedScene& tracked;
    const ServoScene& scene;
    const HapticSettings& settings;
    ServoSnapshot& snapshot;
  };
  struct Tick : Subject {
    const DeviceLimits& limits;  ///< Limits at the handle.
    double period;
  };

  /// What the springs of a tick add up to, before what the device bears.
  struct SpringSum {
    SpringParameters parameters;
    Wrench wrench{};
    SpringDirections directions{};
  };

  void letGo(const RigidTransform& device, const glm::dvec3& centreInPart) noexcept;
  void takePose(const Tick& tick, const RigidTransform& handle) noexcept;
  /// Pull toward the scene's guidance, on the handle as it is.
  GuidancePull pullOfGuidance(const Tick& tick) noexcept;
  /// True if every body searched for minima has a valid pose.
  bool areBodiesPlaced(const Tick& tick) const noexcept;
  Wrench feelSprings(const Tick& tick) noexcept;
  LimitedCoupling feelProxy(const Tick& tick) noexcept;
  /// Where the hand feels the part, if the proxy's constraints want it there: what was felt ahead of the part may come
  /// back only as fast as that gives the hand little energy.
  RigidTransform withoutLeap(const Tick& tick, const RigidTransform& felt) noexcept;
  /// The proxy's part of a tick, once the wrench is on its way.
  void moveOn(const Subject& subject) noexcept;
  /// Finds the minima within `share` of the cutoff and writes them to the snapshot. Adds the wrench of `springs`,
  /// unless null, and the directions in which they push.
  MinimaFinder::Result findMinima(const Subject& subject, double share, SpringSum* springs) noexcept;
  void showMinima(const Subject& subject) noexcept;
  /// Min distance according to the contacts if it is within their reach, else infinity [m].
  double distanceOfContacts(const Subject& subject) const noexcept;
  void movePart(const Subject& subject, const RigidTransform& pose) noexcept;
  void writePose(const Subject& subject) const noexcept;
  void describeProxy(const Subject& subject) noexcept;
  static void showOverlaps(const Subject& subject) noexcept;
  /// Accounts for what the hand did since the last tick, before the part moves on.
  void account(const Tick& tick, const RigidTransform& handleBefore) noexcept;
  void send(const Tick& tick, const LimitedCoupling& felt, const HandleInput& input) noexcept;
  BodyMotion smoothed(const BodyMotion& before, const RigidTransform& pose, const glm::dvec3& centre,
                      double period) const noexcept;

  WorkspaceMapper mapper_;
  PeriodMeter periodMeter_;
  GuidanceFollower guidance_;
  GuidancePull pull_;  ///< At the handle's pose.
  Proxy proxy_;
  MinimaFinder minima_;
  PassivityController passivity_;
  WrenchConditioner conditioner_;

  BodyMotion handle_, part_;  ///< Twists are filtered.
  BodyMotion felt_;           ///< The part as the wrench takes it: at Proxy::feltPose(), or `part_`.
  bool isFeltAhead_ = false;  ///< `felt_` was not where the part was proved free.
  double returnEnergy_ = kMaxReturnEnergy;  ///< What it may give the hand by coming back [J].
  std::uint32_t ticksBehind_ = 0;           ///< Ticks that ended before the proxy's way, one after the other.
  bool isTorqueFelt_ = true;                ///< HandleInput::isTorqueFelt of the last feel().
  double period_ = 0.0;                     ///< Of the last feel() [s].
  Twist partStep_;                          ///< Unfiltered twist of the part in the last tick.
  glm::dvec3 partShift_{0.0};               ///< Translation of its centre in the last tick [m].
  Wrench held_;                             ///< The wrench sent in the last tick.
  FeltMass mass_;
  CouplingState coupling_;
  SpringShares springShares_;  ///< Springs mode only.
  ShownReach shownReach_;      ///< Proxy mode only.
  PartId moving_{};
  HapticMode mode_ = HapticMode::Proxy;
  bool hasPose_ = false;
  bool isToBeShown_ = false;  ///< The proxy has moved, and the minima at its pose are not known yet.
  ServoFault fault_ = ServoFault::None;
};

}  // namespace nearfit
