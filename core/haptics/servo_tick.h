#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/servo_scene.h"
#include "core/haptics/spring_law.h"
#include "core/haptics/tracked_scene.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/wrench.h"
#include "core/haptics/wrench_conditioner.h"
#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

struct ServoParameters {
  HapticSettings haptics;
  DeviceLimits limits;
};

enum class ServoFault : std::uint8_t {
  None,
  PoseNotFinite,      ///< Of the handle or of a part; also a rotation far from unit length.
  WrenchNotFinite,    ///< Overflow or NaN in the sum of the springs.
  ParametersInvalid,  ///< Springs, limits or period that are not finite or out of range.
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

/// One tick as others see it; trivially copyable. All in the world frame.
struct ServoSnapshot {
  static constexpr std::size_t kMaxLmds = 512;
  static constexpr std::size_t kMaxContacts = 16, kMaxReleased = 8;

  std::uint64_t tick = 0;  ///< Ticks run so far with this one; 0 before the first.
  double time = 0.0;       ///< Since the servo started [s].
  RigidTransform handle;   ///< worldFromHandle: where the device wants the part's frame.
  RigidTransform proxy;    ///< worldFromPart: where the part is. In the direct mode the same.
  Wrench wrench;           ///< As sent: about the part's centre of mass, clamped.
  Wrench unclampedWrench;
  glm::dvec3 centre{0.0};  ///< The part's centre of mass [m].
  double distance = 0.0;   ///< Least distance [m]; infinity when nothing is within the cutoff.
  double queryTime = 0.0, tickTime = 0.0;  ///< [s]
  std::uint32_t lmdCount = 0;    ///< All minima within the cutoff, also those that are not in `lmds`.
  std::uint32_t storedLmds = 0;  ///< Entries of `lmds` in use, nearest first for each part.
  /// Bodies that were searched anew in this tick, as what is known of them did not cover the pose.
  std::uint32_t lateBodies = 0;
  bool isTruncated = false;
  bool isClamped = false;
  ServoFault fault = ServoFault::None;  ///< Latched: the wrench is zero until the servo is started anew.
  PartId moving{};

  HapticMode mode = HapticMode::Proxy;
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
  std::array<SnapshotContact, kMaxContacts> contacts{};
  std::array<PartId, kMaxReleased> released{};
  std::array<SnapshotLmd, kMaxLmds> lmds{};
};

/// One servo tick: handle pose in, wrench and snapshot out. A pure function of its inputs and of the poses
/// before (for the velocity). No thread or device in here; the clock is read for `queryTime` alone.
class ServoTick {
 public:
  /// Long enough to smooth encoder steps, short enough (80 Hz) not to turn damping into its opposite [s].
  static constexpr double kVelocityTimeConstant = 2e-3;
  /// Minima kept for each body; beyond it the nearest are summed and the snapshot says truncated.
  static constexpr std::size_t kMaxLmdsPerBody = 4096;
  /// Work of a tick on bodies that are searched anew: some 1.5 ms on a slow core. Beyond it the nearest
  /// minima of a body are kept, and the snapshot says truncated.
  static constexpr std::uint64_t kMaxNodePairs = 1U << 15;

  ServoTick();

  /// Forgets velocity and fault.
  void reset() noexcept;

  /// Minima come from the lists of the tracked scene where they cover the pose, and from a search bounded by
  /// kMaxNodePairs where they do not (`lateBodies`); bodies that are far away cost nothing.
  /// Velocities, for damping, come from pose differences through a first-order low-pass of
  /// `kVelocityTimeConstant`. NaN, infinity or a senseless parameter anywhere: zero wrench, the part stays
  /// where it was, the fault is latched.
  ///
  /// @param tracked   What to feel; stays alive and unchanged during the call.
  /// @param handle    worldFromPart wanted by the hand; its quaternion is scaled to unit length.
  /// @param period    Time since the last tick [s]; > 0.
  /// @param snapshot  Filled, but for `tick`, `time` and `tickTime`, which are the caller's.
  /// Real-time safe.
  void run(const TrackedScene& tracked, const ServoParameters& parameters, const RigidTransform& handle,
           double period, ServoSnapshot& snapshot) noexcept;

 private:
  struct BodyTask {
    const ServoScene::Body &body, &moving;
    const CandidateList* list;  ///< May be null.
  };

  void updateTwist(const ServoScene& scene, const RigidTransform& pose, double period) noexcept;
  Wrench feel(const TrackedScene& tracked, const SpringParameters& springs, ServoSnapshot& snapshot) noexcept;
  Wrench feelBody(const BodyTask& task, const SpringParameters& springs, ServoSnapshot& snapshot) noexcept;
  LmdResult findMinima(const BodyTask& task, const RigidTransform& bodyFromPart, double cutoff,
                       ServoSnapshot& snapshot) noexcept;
  void keepForDisplay(PartId other, std::size_t count) noexcept;
  void writeDisplay(ServoSnapshot& snapshot) noexcept;

  LmdScratch scratch_;
  std::vector<Lmd> lmds_;             ///< Minima of one body.
  std::vector<SnapshotLmd> display_;  ///< Nearest minima of all bodies so far; first displayCount_ in use.
  std::size_t displayCount_ = 0;
  std::uint64_t nodePairsLeft_ = 0;
  bool displayWasCut_ = false;
  RigidTransform lastPose_;
  PartId lastMoving_{};
  Twist twist_;  ///< Of the moving part, world frame, filtered.
  bool hasLastPose_ = false;
  ServoFault fault_ = ServoFault::None;
};

}  // namespace nearfit
