#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/friction_contacts.h"
#include "core/haptics/step_program.h"

namespace nearfit {

/// Goal of a step with friction.
struct FrictionGoal {
  StepGoal step;
  double coefficient = 0.0;  ///< Coulomb's coefficient of friction; >= 0, 0 for none.
  /// For each row: from the centre of mass to the part's point, in the axes of a[0..2] [m]. Unused
  /// without friction.
  std::span<const glm::dvec3> arms;
  /// Rotates the axes of a[0..2] into the principal axes of a[3..5]; orthogonal.
  glm::dmat3 principalFromStep{1.0};
  /// Where rows are without what joints lock of them: those directions, orthonormal, and the directions of the
  /// contacts in the axes of a[0..2]. Otherwise empty.
  std::span<const StepVector> locked{};
  std::span<const glm::dvec3> directions{};
};

/// Friction at a row.
struct FrictionPush {
  std::size_t row = 0;  ///< Index in the StepRows.
  /// Tangential push on the part, in the axes of a[0..2], on the scale of the multipliers [m].
  glm::dvec3 push{0.0};
};

/// A step with friction.
struct FrictionSolution {
  StepSolution step;  ///< Optimum for s y0 plus the pushes; rows and reach hold whatever the pushes are.
  std::array<FrictionPush, ActiveRows::kMax> pushes{};
  std::size_t pushCount = 0;
  unsigned sweeps = 0;  ///< Programs solved in total.
  /// Max change of a push in another sweep [m].
  double unsettled = 0.0;
  /// True if `unsettled` is below FrictionProgram::kSettled of the lengths involved. Otherwise the
  /// alternation was stopped, and a push may exceed its disk or fail to oppose the sliding by as much.
  bool isSettled = false;
};

/// The step of StepProgram with dry friction. At each active row a push acts perpendicular to the row's
/// direction, of at most the coefficient times the row's multiplier. It holds the point where it is if it
/// can; otherwise it opposes the sliding.
///
/// Alternates between the program for y0 plus the pushes and a Gauss-Seidel relaxation of pushes, slip and
/// multipliers with fixed active rows; at most `kMaxSweeps` times for each scale of the goal.
///
/// Approximations: Coulomb's isotropic cone, at points, for each step by itself (no memory of where a contact
/// stuck, one coefficient for sticking and sliding, no torque against spinning about the direction). Steps
/// are displacements from rest, so sliding stops when the hand does. With redundant rows the distribution of
/// the pushes is not unique, but their total effect is. With a high coefficient and long arms Coulomb's law
/// itself may have several solutions or none, and the alternation may not settle. A single contact that can
/// hold y0 holds it to rounding, if the floor keeps the clearance from giving way.
///
/// Real-time safe. Source: Panagiotopoulos, A nonlinear programming approach to the unilateral contact- and
/// friction-boundary value problem, 1975 (the alternation); Jean, The non-smooth contact dynamics method,
/// 1999 (the relaxation).
class FrictionProgram {
 public:
  /// Max sweeps for each scale of the goal.
  static constexpr unsigned kMaxSweeps = 8;
  /// Max scales of the goal that are tried to fit the reach.
  static constexpr unsigned kMaxScales = 4;
  /// From this sweep on, pushes go half the way, since pushes that have not settled oscillate.
  static constexpr unsigned kDampedSweep = 5;
  /// Pushes are settled if none would change by more than this fraction of the lengths involved (y0 and the
  /// margin): far finer than a coefficient of friction is known.
  static constexpr double kSettled = 1e-6;
  /// From this sweep on, settled pushes are accepted. A single contact is exact sooner.
  static constexpr unsigned kPatience = 3;
  /// Max changes of the active rows in a call.
  static constexpr unsigned kMaxChanges = 512;

  /// Finds the step for a goal. If the goal is not usable (also if an arm is missing, or the coefficient is
  /// negative or not finite) the part stands still.
  FrictionSolution solve(const StepRows& rows, const FrictionGoal& goal) noexcept;

 private:
  /// Result for one scale of the goal.
  struct Attempt {
    FrictionContacts applied;  ///< With the pushes that the step includes.
    double unsettled = 0.0;
    bool isSettled = false;
  };
  /// Attempts that searchStep() may return to.
  struct Kept {
    Attempt last, chosen, tooLong;
    void best() noexcept { chosen = last; }
    void above() noexcept { tooLong = last; }
    void useAbove() noexcept { chosen = tooLong; }
  };

  DualStepSolver::Point alternate(const StepRows& rows, const FrictionGoal& goal, const StepVector& wanted,
                                  Attempt& best) noexcept;

  DualStepSolver solver_;
  FrictionContacts contacts_;
  unsigned sweeps_ = 0;
};

}  // namespace nearfit
