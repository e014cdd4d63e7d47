#pragma once

/// A hand of one dimension thrown at a sampled wall, with a passivity controller that may act.
namespace nearfit::test {

/// Whether the wall resists a force or is a hinge that resists a torque.
enum class Along { Force, Torque };

/// Beyond 0 it pushes back from the position `delay` ticks ago, sampled and held for a tick.
struct Wall {
  double stiffness = 0.0, damping = 0.0;
  int delay = 0;
};

/// SI units: of translation or of rotation.
struct WallTrial {
  static constexpr double kPeriod = 1e-3;  ///< Of a tick [s].

  Wall wall;
  double mass = 0.2, damping = 1.0;  ///< Of the hand.
  double position = -5e-4, velocity = 0.05, push = 1.0;
  bool isControlled = false;
  Along along = Along::Force;
  int ticks = 4000;
};

struct WallOutcome {
  double early = 0.0, late = 0.0;  ///< Fastest motion in the first and in the last quarter.
  double largestDebt = 0.0;        ///< As the controller has it [J].
  int paidTicks = 0;               ///< In which the controller would damp, controlled or not.
};

WallOutcome meetWall(const WallTrial& trial);

/// A hand that comes near a wall and is pushed against it.
WallTrial wallOf(double stiffness, int delay = 0);

/// A hand that leans on a wall, at rest but for a nudge so small that it stays in contact.
WallTrial leaningOn(double stiffness, double mass);

}  // namespace nearfit::test
