#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/haptics/contact_finder.h"
#include "core/haptics/friction_program.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/step_judge.h"
#include "core/haptics/step_program.h"
#include "core/haptics/tracked_scene.h"

namespace nearfit {

/// How the proxy fared in a tick.
struct ProxyAccount {
  std::uint32_t subSteps = 0;
  std::uint32_t shortenedSteps = 0;   ///< Halved, as more was not proved free.
  std::uint32_t refusedSteps = 0;     ///< Not taken at all.
  std::uint32_t constraintCount = 0;  ///< Of the last step's program.
  bool isWaiting = false;             ///< For the clearance at its pose: it stands meanwhile.
  bool isStarved = false;             ///< Lists did not reach where it would go, nor the work of the tick.
};

/// Something that holds the proxy back.
struct ProxyContact {
  BodyContact contact;
  /// What of the wanted way it takes away, along its direction [m] for a body of mass one.
  double push = 0.0;
};

/// Where the moving part is: it follows a target as far as the other bodies let it, and never meets one.
///
/// A tick takes it there in steps. Each step is the shortest way, in the metric of the part's mass (as the
/// coupling weighs turns against shifts), that
/// keeps every near pair of features a margin apart to first order (StepProgram); it is taken only where it
/// is proved that nothing is met on the way: no point of the part moves as far as the nearest body is away.
/// The distance at the step's end is no part of the proof, since minima tell it only where bodies do not
/// overlap. Standing still is always possible. Source: Ortega, Redon & Coquillart 2007, on local minimum
/// distances; conservative advancement.
class Proxy {
 public:
  static constexpr std::uint32_t kMaxSubSteps = 24;

  Proxy();

  /// Puts it anywhere, which nothing is known of yet.
  void place(const RigidTransform& worldFromPart) noexcept;
  const RigidTransform& pose() const noexcept { return pose_; }

  /// Takes note that no body but the overlapping ones is nearer than this at the present pose [m].
  void noteDistance(double distance) noexcept;

  /// One tick. Stands still while it is not known which bodies it overlaps (TrackedScene::clearance).
  /// @param target     worldFromPart; finite, unit quaternion.
  /// @param turnScale  What radii of gyration count times, so that the way is shortest in the energy of the
  ///                   coupling that pulls (turnScale() of virtual_coupling.h); > 0.
  /// Real-time safe.
  void follow(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
              double turnScale = 1.0) noexcept;

  const ProxyAccount& account() const noexcept { return account_; }
  /// What holds it now.
  std::span<const ProxyContact> contacts() const noexcept;
  /// The distance known at the present pose; a bound below [m].
  double distance() const noexcept { return here_.distance; }
  std::uint32_t lateBodies() const noexcept { return finder_.lateBodies(); }
  /// Of the last tick, on contacts (ContactFinder::work).
  std::uint64_t work() const noexcept { return finder_.work(); }
  /// Of the last tick, what the search for contacts took [s].
  double queryTime() const noexcept { return queryTime_; }

 private:
  /// A small motion: of the centre of mass, and about it, in the world.
  struct Motion {
    glm::dvec3 shift{0.0};  ///< [m]
    glm::dvec3 spin{0.0};   ///< Axis times angle [rad].
  };
  struct Tick {
    const TrackedScene& tracked;
    const RigidTransform& target;
    const ProxySettings& settings;
    MassMetric metric;  ///< Its gyration scaled.
  };

  bool isCleared(const TrackedScene& tracked) noexcept;
  static Motion motionBetween(const ServoScene& scene, const RigidTransform& from,
                              const RigidTransform& to) noexcept;
  /// No point of the part moves farther [m].
  static double travelOf(const ServoScene& scene, const Motion& motion) noexcept;
  static double travelBetween(const ServoScene& scene, const RigidTransform& from,
                              const RigidTransform& to) noexcept;
  /// The farthest that a point of the part is from where the target has it [m].
  double wayTo(const Tick& tick) const noexcept;
  RigidTransform moved(const ServoScene& scene, const Motion& motion) const noexcept;
  /// What became of a step of a tick.
  enum class Outcome : std::uint8_t {
    Moved,
    AtRest,  ///< It is where it is best.
    Stuck,   ///< It could not go on in this tick.
  };
  using Verdict = StepJudge::Verdict;

  bool isResting(const Tick& tick) const noexcept;
  double targetMotion(const Tick& tick) const noexcept;
  double marginHere() const noexcept;
  Outcome step(const Tick& tick) noexcept;
  Outcome freeStep(const Tick& tick, const Motion& wanted) noexcept;
  Outcome constrainedStep(const Tick& tick, const Motion& wanted) noexcept;
  Outcome programStep(const Tick& tick, const StepGoal& goal) noexcept;
  Outcome takeShortened(const Tick& tick, StepTrial trial, Motion motion, double travel) noexcept;
  StepGoal goalOf(const Tick& tick, const Motion& wanted) const noexcept;
  bool fillRows(const Tick& tick, double reach) noexcept;
  StepSolution solve(const Tick& tick, const StepGoal& goal) noexcept;
  void keepContacts(const StepSolution& solution) noexcept;
  Surroundings lookAround(const Tick& tick, const RigidTransform& pose, std::span<BodyContact> out) noexcept;
  void raiseFloor(const Tick& tick) noexcept;
  Verdict take(const Tick& tick, const RigidTransform& pose, double travel,
               StepTrial* trial = nullptr) noexcept;

  ContactFinder finder_;
  StepRows rows_;
  StepProgram program_;
  FrictionProgram frictionProgram_;
  StepJudge judge_;
  std::vector<BodyContact> around_, next_;  ///< Contacts here, and at a pose that is tried.
  std::vector<std::uint32_t> rowContact_;   ///< Of each row, its contact in `around_`.
  std::vector<glm::dvec3> rowArm_;          ///< Of each row, from the centre of mass to its point [m].
  std::array<ProxyContact, ActiveRows::kMost> holding_;
  std::size_t holdingCount_ = 0;

  RigidTransform pose_;
  Surroundings here_;
  bool isHereKnown_ = false;
  double wayLeft_ = 0.0;      ///< That a point of it may still go in this tick [m].
  double firstTravel_ = 0.0;  ///< Of the tick's first step [m].
  std::optional<RigidTransform> lastTarget_;
  struct Rest {
    RigidTransform target;
    ProxySettings settings;
    double turnScale = 0.0;
    bool isAtRest = false;
  };
  Rest rest_;
  double turnScale_ = 1.0;
  double margin_ = 0.0;  ///< That `here_` was found for.
  std::uint64_t clearedSerial_ = 0;
  ProxyAccount account_;
  double queryTime_ = 0.0;
};

}  // namespace nearfit
