#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/haptics/friction_program.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/locked_motions.h"
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
  bool isStarved = false;             ///< Neither the lists nor a search covered where it would go.
  bool isBehind = false;              ///< The tick's work ended before its way.
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
/// still is always possible.
///
/// Where thousands of pairs are near, a step takes longer than a tick: its work, counted and not timed, goes on
/// in the next. The hand does not wait for it. It feels feltPose(), which is on the target's side of the pose:
/// as far as the constraints known at the pose allow.
///
/// Joints of the scene are equalities: the hand's pose is put on them first, and a step has nothing along the motions
/// that they lock but what leads back to them. So the program stays as it is, and so does each proof. Where a joint would
/// press the part into another one, the contact wins.
///
/// Source: Ortega, Redon & Coquillart 2007, on local minimum distances, and for the two rates; conservative
/// advancement.
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

  /// Starts a tick. The part stands still while it is unknown which bodies it overlaps (Clearance).
  /// @param target     Pose to move towards, worldFromPart; finite, unit quaternion. With joints, the pose on them
  ///                   nearest to it, in the coupling's energy, takes its place.
  /// @param turnScale  Factor on the radii of gyration that makes steps nearest in the energy of the coupling
  ///                   that pulls (turnScale() in virtual_coupling.h); > 0.
  /// Real-time safe.
  void begin(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
             double turnScale = 1.0) noexcept;
  /// Goes on with the tick's way, until it ends or the work is spent. The scene is that of begin().
  /// @param work  As counted by ContactFinder::work(), besides what was allowed before in this tick.
  /// Returns true if the way has ended. Real-time safe.
  bool advance(const TrackedScene& tracked, std::uint64_t work, ContactFinder::Excess excess) noexcept;
  /// Finds feltPose(). Real-time safe: the time depends on the number of contacts alone, which is bounded.
  void feel(const TrackedScene& tracked) noexcept;
  /// Runs a whole tick: begin(), then advance() with ContactFinder::kUsualWork. Real-time safe.
  void follow(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
              double turnScale = 1.0) noexcept;

  /// Where the part would be by the constraints known in this tick, which is where the hand feels it. Equal to
  /// pose() if the tick's way had ended when feel() was called. Not proved free.
  const RigidTransform& feltPose() const noexcept { return felt_; }

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
  /// ContactFinder::isAmongThousands().
  bool isAmongThousands() const noexcept { return finder_.isAmongThousands(); }
  /// ContactFinder::isCrowded().
  bool isCrowded() const noexcept { return finder_.isCrowded(); }
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
    const MassMetric& metric;  ///< With scaled gyration.
  };
  /// How joints hold the part at a pose.
  struct Hold {
    LockedMotions locked;
    StepVector back{};    ///< The way back to the joints that a step takes.
    bool isWhole = true;  ///< It is all of that way.
  };
  /// Rows of a program, with the contacts that they come from.
  struct ContactRows {
    StepRows rows;  ///< With joints: of the rest of the step, beside the way back.
    Hold hold;
    std::vector<std::uint32_t> contact;  ///< For each row, the index of its contact in `around_`.
    std::vector<glm::dvec3> arm;         ///< For each row, from the centre of mass to its point [m].
    std::vector<glm::dvec3> direction;   ///< With joints: for each row, its direction.
  };

  /// Result of a step.
  enum class Outcome : std::uint8_t {
    Moved,
    AtRest,  ///< It is where it is best.
    Stuck,   ///< It cannot go on in this tick.
    Behind,  ///< It could go on, but too little is known, or too many steps were taken.
  };
  using Verdict = StepJudge::Verdict;
  /// Next part of the tick.
  enum class Stage : std::uint8_t { LookAround, Plan, Try, Done };

  /// A pose to step to, while it is looked at.
  struct Trial {
    RigidTransform pose;
    double travel = 0.0;  ///< To that pose [m].
    Motion motion;        ///< The same, for poses short of the target.
    int shortenings = 0;
    bool isTarget = false;  ///< The target itself; the tick ends there.
    bool isFree = false;    ///< Nothing is near: no program.
    /// For a program's step: its goal, its cost if that is judged, and the outcome if it gains nothing.
    StepGoal goal;
    std::optional<StepTrial> judged;
    Outcome best = Outcome::AtRest;
    bool isPinched = false;  ///< The goal accepts the clearance here.
  };

  Tick tick(const TrackedScene& tracked) const noexcept { return {tracked, target_, settings_, metric_}; }
  bool isCleared(const TrackedScene& tracked) noexcept;
  static Motion motionBetween(const ServoScene& scene, const RigidTransform& from,
                              const RigidTransform& to) noexcept;
  /// Upper bound on the travel of any point of the part [m].
  static double travelOf(const ServoScene& scene, const Motion& motion) noexcept;
  /// Upper bound on the travel of any point of the part to the target [m].
  double wayTo(const Tick& tick) const noexcept;
  RigidTransform moved(const ServoScene& scene, const Motion& motion) const noexcept;

  bool isResting(const Tick& tick) const noexcept;
  void end(Outcome outcome) noexcept;
  double marginHere() const noexcept;
  /// Does the next part of the tick's way; false if the work ran out.
  bool goOn(const Tick& tick) noexcept;
  /// Plans a step: sets the trial and returns Moved, or returns how the tick ends.
  Outcome plan(const Tick& tick) noexcept;
  Outcome planFree(const Tick& tick, const Motion& wanted) noexcept;
  Outcome planConstrained(const Tick& tick, const Motion& wanted) noexcept;
  Outcome planProgram(const Tick& tick, const StepGoal& goal, bool isPinched) noexcept;
  /// The same for a goal that accepts the present clearance, if the part is pinched.
  Outcome planPinched(const Tick& tick, const StepGoal& goal) noexcept;
  /// Acts on the verdict on the trial. Returns Moved if the tick goes on.
  Outcome settle(const Tick& tick, Verdict verdict) noexcept;
  Outcome settleProgram(const Tick& tick, Verdict verdict) noexcept;
  /// Shortens the trial to this share, or to less.
  void shorten(const Tick& tick, double share) noexcept;
  void setTrial(const Tick& tick, const Motion& motion, double travel) noexcept;
  void setTrialToTarget(const Tick& tick, double travel) noexcept;
  StepGoal goalOf(const Tick& tick, const Motion& wanted) const noexcept;
  /// True if there are joints and the part is on them.
  bool isOnJoints(const Tick& tick) const noexcept;
  /// Returns what the joints lock, and how much of the way back to them a step to this goal takes.
  /// @param reach  Contacts within it count [m].
  Hold holdFor(const Tick& tick, const StepGoal& goal, double reach) const noexcept;
  /// True if a step that no contact holds may end at the target.
  bool isTargetInReach(const Tick& tick, const Hold& hold, double reach) const noexcept;
  /// Fills the rows, for the hold that is set.
  bool fillRows(const Tick& tick, double reach, ContactRows& out) noexcept;
  template <bool kIsHeld>
  bool fillRowsOf(const Tick& tick, double reach, ContactRows& out) noexcept;
  StepSolution solve(const Tick& tick, const ContactRows& rows, const StepGoal& goal,
                     unsigned mostChanges) noexcept;
  /// The same for a goal that has nothing along what joints lock.
  StepSolution solveFree(const Tick& tick, const ContactRows& rows, const StepGoal& goal,
                         unsigned mostChanges) noexcept;
  Motion motionOf(const Tick& tick, const StepSolution& solution) const noexcept;
  RigidTransform leadPose(const Tick& tick) noexcept;
  void keepContacts(const ContactRows& rows, const StepSolution& solution) noexcept;
  Surroundings lookAround(const Tick& tick, const RigidTransform& pose, std::span<BodyContact> out,
                          const ContactFinder::Step* step) noexcept;
  void raiseFloor(const Tick& tick) noexcept;
  /// Looks at the trial's pose, and moves there if that is right; no value if the work ran out.
  std::optional<Verdict> take(const Tick& tick) noexcept;

  ContactFinder finder_;
  StepProgram program_;
  FrictionProgram frictionProgram_;
  StepJudge judge_;
  std::vector<BodyContact> around_, next_;  ///< Contacts here, and at a pose being tried.
  ContactRows rows_, feltRows_;             ///< For steps, and for feltPose().
  bool areFeltRowsFilled_ = false;
  std::array<ProxyContact, ActiveRows::kMax> holding_;
  std::size_t holdingCount_ = 0;

  RigidTransform pose_, felt_;
  Surroundings here_;
  bool isHereKnown_ = false;
  Stage stage_ = Stage::Done;
  Trial trial_;
  bool isWayUnknown_ = false;  ///< Nothing was known of the way of a long trial.
  bool isForEarlier_ = false;  ///< The trial was planned for an earlier target.
  bool isTrying_ = false;      ///< The trial of an earlier tick goes on.
  double wayLeft_ = 0.0;       ///< Travel that is left in this tick [m].
  double firstTravel_ = 0.0;   ///< Travel of the tick's first step [m].
  double stride_ = 0.0;        ///< Length up to which steps have been taken lately [m].
  RigidTransform target_;      ///< On the joints.
  ProxySettings settings_;
  MassMetric metric_;
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
