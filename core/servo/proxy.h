#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/haptics/friction_program.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/step_judge.h"
#include "core/haptics/step_program.h"
#include "core/servo/contact_finder.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Statistics of a tick of the proxy.
struct ProxyAccount {
  std::uint32_t subSteps = 0;         ///< Steps taken.
  std::uint32_t shortenedSteps = 0;   ///< Steps halved because more was not proved free.
  std::uint32_t refusedSteps = 0;     ///< Steps not taken at all.
  std::uint32_t constraintCount = 0;  ///< Rows of the last step's program.
  bool isWaiting = false;             ///< It stands still until the clearance at its pose is known.
  bool isStarved = false;             ///< Neither the lists nor the tick's work covered where it would go.
};

/// A contact that holds the proxy back.
struct ProxyContact {
  BodyContact contact;
  /// Part of the wanted motion that it takes away, along its direction [m], for a body of unit mass.
  double push = 0.0;
};

/// The pose of the moving part: it follows a target as far as the other bodies allow, and never meets one.
///
/// A tick moves it in steps. Each step is the motion nearest to the wanted one that keeps every near pair
/// of features a margin apart to first order (StepProgram), in the metric of the part's mass, with rotation
/// weighed against translation as in the coupling. It is taken only if it is proved that nothing is met on
/// the way: no point of the part moves as far as the nearest body is away. The distance at the step's end
/// is not part of the proof, since minima give the distance only for bodies that do not overlap. Standing
/// still is always possible. Source: Ortega, Redon & Coquillart 2007, on local minimum distances;
/// conservative advancement.
class Proxy {
 public:
  /// Max steps in a tick.
  static constexpr std::uint32_t kMaxSubSteps = 24;

  /// Allocates all work space; nothing else allocates.
  Proxy();

  /// Puts the part at any pose. Nothing is known of it yet, so the part stands still until its clearance is.
  void place(const RigidTransform& worldFromPart) noexcept;
  /// Pose of the part, worldFromPart.
  const RigidTransform& pose() const noexcept { return pose_; }

  /// Records a lower bound on the distance from the present pose to all bodies that the part does
  /// not overlap [m].
  void noteDistance(double distance) noexcept;

  /// Runs one tick. The part stands still while it is unknown which bodies it overlaps (Clearance).
  /// @param target     Pose to move towards, worldFromPart; finite, unit quaternion.
  /// @param turnScale  Factor on the radii of gyration that makes steps nearest in the energy of the coupling
  ///                   that pulls (turnScale() in virtual_coupling.h); > 0.
  /// Real-time safe.
  void follow(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
              double turnScale = 1.0) noexcept;

  /// Statistics of the last tick.
  const ProxyAccount& account() const noexcept { return account_; }
  /// The contacts that hold the part now, in world coordinates; valid until the next tick.
  std::span<const ProxyContact> contacts() const noexcept;
  /// Lower bound on the distance from the present pose to the bodies that the part does not overlap [m].
  double distance() const noexcept { return here_.distance; }
  /// ContactFinder::lateBodies() of the last tick.
  std::uint32_t lateBodies() const noexcept { return finder_.lateBodies(); }
  /// ContactFinder::work() of the last tick.
  std::uint64_t work() const noexcept { return finder_.work(); }
  /// Time that the search for contacts took in the last tick [s].
  double queryTime() const noexcept { return queryTime_; }

 private:
  /// A small motion: translation of the centre of mass, and rotation about it; world frame.
  struct Motion {
    glm::dvec3 shift{0.0};  ///< [m]
    glm::dvec3 spin{0.0};   ///< Axis times angle [rad].
  };
  struct Tick {
    const TrackedScene& tracked;
    const RigidTransform& target;
    const ProxySettings& settings;
    MassMetric metric;  ///< With scaled gyration.
  };

  bool isCleared(const TrackedScene& tracked) noexcept;
  static Motion motionBetween(const ServoScene& scene, const RigidTransform& from,
                              const RigidTransform& to) noexcept;
  /// Upper bound on the travel of any point of the part [m].
  static double travelOf(const ServoScene& scene, const Motion& motion) noexcept;
  static double travelBetween(const ServoScene& scene, const RigidTransform& from,
                              const RigidTransform& to) noexcept;
  /// Upper bound on the travel of any point of the part to the target [m].
  double wayTo(const Tick& tick) const noexcept;
  RigidTransform moved(const ServoScene& scene, const Motion& motion) const noexcept;
  /// Result of a step.
  enum class Outcome : std::uint8_t {
    Moved,
    AtRest,  ///< It is where it is best.
    Stuck,   ///< It cannot go on in this tick.
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
  std::vector<BodyContact> around_, next_;  ///< Contacts here, and at a pose being tried.
  std::vector<std::uint32_t> rowContact_;   ///< For each row, the index of its contact in `around_`.
  std::vector<glm::dvec3> rowArm_;          ///< For each row, from the centre of mass to its point [m].
  std::array<ProxyContact, ActiveRows::kMax> holding_;
  std::size_t holdingCount_ = 0;

  RigidTransform pose_;
  Surroundings here_;
  bool isHereKnown_ = false;
  double wayLeft_ = 0.0;      ///< Travel that is left in this tick [m].
  double firstTravel_ = 0.0;  ///< Travel of the tick's first step [m].
  std::optional<RigidTransform> lastTarget_;
  struct Rest {
    RigidTransform target;
    ProxySettings settings;
    double turnScale = 0.0;
    bool isAtRest = false;
  };
  Rest rest_;
  double turnScale_ = 1.0;
  double margin_ = 0.0;  ///< Margin that `here_` was found for [m].
  std::uint64_t clearedSerial_ = 0;
  ProxyAccount account_;
  double queryTime_ = 0.0;
};

}  // namespace nearfit
