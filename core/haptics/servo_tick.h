#pragma once

#include <cstdint>

#include "core/haptics/device_limits.h"
#include "core/haptics/free_motion.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/minima_finder.h"
#include "core/haptics/passivity_controller.h"
#include "core/haptics/period_meter.h"
#include "core/haptics/proxy.h"
#include "core/haptics/servo_snapshot.h"
#include "core/haptics/shown_reach.h"
#include "core/haptics/tracked_scene.h"
#include "core/haptics/workspace_mapper.h"
#include "core/haptics/wrench_conditioner.h"

namespace nearfit {

struct ServoParameters {
  HapticSettings haptics;
  DeviceLimits limits;
};

/// One servo tick: the device's pose in, wrench and snapshot out. A function of its inputs and of the ticks
/// before. No thread or device in here; the clock is read for times alone.
///
/// The device's pose becomes the handle's (WorkspaceMapper). In the proxy mode the part follows the handle as
/// far as it can (Proxy), and the hand feels the coupling between the two; in the mode of springs the part is
/// where the handle is, and the hand feels the sum of the springs. What is felt is kept passive
/// (PassivityController) and within what the device bears (WrenchConditioner).
///
/// A tick has two halves: feel() has all that the hand waits for, show() what only others look at. In the
/// proxy mode that is the minima: they are found when the wrench is on its way.
///
/// No tick does more than mostWork() (work_bound.h). In the proxy mode, where nothing that is felt depends on
/// minima, the cutoff for them is made shorter as long as they take more than there is time for (a nut on its
/// thread has thousands), and the snapshot says truncated.
class ServoTick {
 public:
  /// Long enough to smooth encoder steps, short enough (80 Hz) not to turn damping into its opposite [s].
  static constexpr double kVelocityTimeConstant = 2e-3;

  ServoTick() = default;

  /// Forgets velocities, energies, the proxy and the fault: as if it had never run.
  void reset() noexcept;

  /// The wrench and what it comes from; `deviceWrench` is final. show() follows, before the next one.
  ///
  /// Velocities, for damping, come from pose differences through a first-order low-pass of
  /// `kVelocityTimeConstant`. NaN, infinity or a senseless parameter anywhere: zero wrench, the part stays
  /// where it was, the fault is latched.
  ///
  /// @param tracked   What to feel; stays alive and unchanged until show() is back. Where it does not hold
  ///                  for the pose, the tick searches for itself within a bound (`lateBodies`).
  /// @param input     From the device; its quaternion is scaled to unit length.
  /// @param period    Time since the last tick [s]; > 0.
  /// Real-time safe.
  void feel(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
            double period, ServoSnapshot& snapshot) noexcept;

  /// Completes the snapshot of feel(): minima, least distance, contacts, parts that are not felt.
  ///
  /// @param snapshot  As feel() left it. Filled afterwards, but for `tick`, `time` and `tickTime`, which are
  ///                  the caller's.
  /// A pose that is none, of a part that came near in this tick, is a fault from the next tick on.
  /// Real-time safe.
  void show(const TrackedScene& tracked, const ServoParameters& parameters, ServoSnapshot& snapshot) noexcept;

  /// Both, for those who have no device to answer.
  void run(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
           double period, ServoSnapshot& snapshot) noexcept;

 private:
  struct Subject {
    const TrackedScene& tracked;
    const ServoScene& scene;
    const HapticSettings& settings;
    ServoSnapshot& snapshot;
  };
  struct Tick : Subject {
    const DeviceLimits& limits;  ///< As at the handle.
    double period;
  };

  void letGo(const RigidTransform& device, const glm::dvec3& centreInPart) noexcept;
  void takePose(const Tick& tick, const RigidTransform& handle) noexcept;
  /// Of those that minima are looked for in.
  bool areBodiesPlaced(const Tick& tick) const noexcept;
  Wrench feelSprings(const Tick& tick) noexcept;
  Wrench feelProxy(const Tick& tick) noexcept;
  /// Those within `share` of the cutoff.
  MinimaFinder::Result findMinima(const Subject& subject, double share, const SpringParameters* springs,
                                  Wrench& sum) noexcept;
  void showMinima(const Subject& subject) noexcept;
  /// The least distance as contacts tell it, where they reach; else infinity [m].
  double distanceOfContacts(const Subject& subject) const noexcept;
  void movePart(const Tick& tick, const RigidTransform& pose) noexcept;
  void describeProxy(const Subject& subject) noexcept;
  /// What the hand did since the last tick, before the part moves on.
  void account(const Tick& tick, const RigidTransform& handleBefore) noexcept;
  void send(const Tick& tick, const Wrench& wrench, const HandleInput& input) noexcept;
  BodyMotion smoothed(const BodyMotion& before, const RigidTransform& pose, const glm::dvec3& centre,
                      double period) const noexcept;

  WorkspaceMapper mapper_;
  PeriodMeter periodMeter_;
  Proxy proxy_;
  MinimaFinder minima_;
  PassivityController passivity_;
  WrenchConditioner conditioner_;

  BodyMotion handle_, part_;   ///< Twists are filtered.
  Twist partStep_;             ///< Of the part in the last tick, as it was.
  glm::dvec3 partShift_{0.0};  ///< Of its centre in the last tick [m].
  Wrench held_;                ///< As sent in the last tick.
  Felt felt_;
  CouplingState coupling_;
  ShownReach shownReach_;  ///< In the proxy mode.
  PartId moving_{};
  HapticMode mode_ = HapticMode::Proxy;
  bool hasPose_ = false;
  bool isToBeShown_ = false;  ///< The proxy has moved, and minima at its pose are not known yet.
  ServoFault fault_ = ServoFault::None;
};

}  // namespace nearfit
