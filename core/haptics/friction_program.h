#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/haptics/friction_contacts.h"
#include "core/haptics/step_program.h"

namespace nearfit {

struct FrictionGoal {
  StepGoal step;
  double coefficient = 0.0;  ///< Coulomb's; >= 0, 0 for none.
  /// Of each row: from the centre of mass to the part's point, in the axes of a[0..2] [m].
  std::span<const glm::dvec3> arms;
  /// Turns a vector in the axes of a[0..2] into the principal axes of a[3..5]; orthogonal.
  glm::dmat3 principalFromStep{1.0};
};

/// What rubs at a row.
struct FrictionPush {
  std::size_t row = 0;
  /// Tangential push on the part, in the axes of a[0..2], on the scale of the multipliers [m].
  glm::dvec3 push{0.0};
};

struct FrictionSolution {
  StepSolution step;  ///< The optimum for s y0 and the pushes; rows and reach hold whatever those are.
  std::array<FrictionPush, ActiveRows::kMost> pushes{};
  std::size_t pushCount = 0;
  unsigned sweeps = 0;  ///< Programs solved, in all.
  /// By how much the pushes would change in a further sweep [m].
  double unsettled = 0.0;
  /// That is below FrictionProgram::kSettled of the lengths in play. Otherwise the alternation was ended, and
  /// a push may exceed its disk or not oppose the sliding by as much.
  bool isSettled = false;
};

/// The step of StepProgram with dry friction: at each active row a push in the plane square to the row's
/// direction, at most the coefficient times the row's multiplier, that keeps the point where it is if that
/// is enough, and else opposes the way that it slides.
///
/// Alternates between the program for y0 and the pushes, and a Gauss-Seidel relaxation of pushes, slip and
/// multipliers with the active rows held; at most `kMostSweeps` times for each scale of the goal.
///
/// What it approximates: Coulomb's isotropic cone, at points, for one step by itself (no memory of where a
/// contact stuck, one coefficient for sticking and sliding, no torque against spinning about the direction).
/// Steps are displacements from rest, so that what slides stops when the hand does. Where rows outnumber what
/// can be told apart, how the pushes share is not unique; what they do together is. With a high coefficient
/// and long arms Coulomb's law itself may have several solutions or none, and the alternation may not settle.
/// A single contact that can hold y0 holds it to rounding, where the floor keeps the clearance from giving.
///
/// Real-time safe. Source: Panagiotopoulos, A nonlinear programming approach to the unilateral contact- and
/// friction-boundary value problem, 1975 (the alternation); Jean, The non-smooth contact dynamics method,
/// 1999 (the relaxation).
class FrictionProgram {
 public:
  static constexpr unsigned kMostSweeps = 8;
  /// Scales of the goal that are tried for the reach; each takes its sweeps.
  static constexpr unsigned kMostScales = 4;
  /// From this sweep on pushes go half of the way, since what has not settled swings.
  static constexpr unsigned kDampedSweep = 5;
  /// Pushes are settled when none would change by more than this fraction of the lengths in play (y0 and the
  /// margin): far finer than a coefficient of friction is known.
  static constexpr double kSettled = 1e-6;
  /// Sweeps after which that is good enough; a single contact is exact sooner.
  static constexpr unsigned kPatience = 3;
  /// Changes of the active rows in a call.
  static constexpr unsigned kMostChanges = 512;

  /// For a goal that is not usable (an arm missing or a coefficient below 0 or not finite included) the part
  /// stands still.
  FrictionSolution solve(const StepRows& rows, const FrictionGoal& goal) noexcept;

 private:
  /// What a scale of the goal ended with.
  struct Attempt {
    FrictionContacts applied;  ///< With the pushes that the step has.
    double unsettled = 0.0;
    bool isSettled = false;
  };
  /// Attempts that searchStep may come back to.
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
