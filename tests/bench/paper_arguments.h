#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/bench_clock.h"
#include "tests/bench/error_method.h"
#include "tests/bench/paper_figures.h"
#include "tests/bench/paper_rows.h"

/// What the paper argues in 4.1 and 4.3 and shows in figures 4 to 6, measured: which springs to sum.
namespace nearfit::bench {

/// The paper's law exactly as printed (4.3), with LMD_i as the vector from the part to the scene, so that the force
/// pushes away: f_i = (cutoff - |LMD_i|) LMD_i, F = sum of -k f_i, torque = sum of p_i x f_i. The print has neither k
/// nor the sign in the torque, so that it is -1/k times that of the forces.
/// @param centreOfMass  In the frame of `lmds` [m].   @param stiffness  k [N/m^2].
/// The torque is in m^3, not N m. Minima at or beyond the cutoff contribute nothing.
Wrench wrenchAsPrinted(std::span<const Lmd> lmds, double cutoff, double stiffness,
                       const glm::dvec3& centreOfMass) noexcept;

/// Springs at a pose, and what they sum to; see ContactAnswer.
using SpringMode = std::function<void(const RigidTransform& sceneFromPart, ContactAnswer& answer)>;

/// What is left of a change between two poses when the motion is halved again and again, each time keeping the half
/// with the larger change of force: nothing of a smooth change, all of a jump.
struct Jump {
  double size = 0.0;    ///< Of the force [N].
  double change = 0.0;  ///< Of the force over the whole motion [N].
  /// Springs on one side of the jump alone: at the cutoff (to within the motion that is left), and nearer than that.
  std::size_t atCutoff = 0, within = 0;
};

/// @param cutoff  [m]   @param partRadius  Of the part about its origin [m].
Jump jumpBetween(const SpringMode& mode, const RigidTransform& from, const RigidTransform& to, double cutoff,
                 double partRadius);

/// Halvings of a motion: what is left is smooth to 1/4096 of what it was.
constexpr int kHalvings = 12;

/// Springs of a pose that the pose before had not, by their features, and that are no deeper within the cutoff than the
/// motion between the two explains: born at the cutoff. Of each its push where 1 N is that of a spring pressed all the
/// way: 1 - distance / cutoff.
/// @param motion  No point of the part moved farther [m].
std::vector<double> onsetsAtCutoff(const ContactAnswer& before, const ContactAnswer& after, double cutoff,
                                   double motion);

struct ArgumentOptions {
  std::size_t ticks = 1000;      ///< Of the hand's path, at 1 kHz.
  double speed = 0.1;            ///< Of the hand along its path [m/s]; the larger body's diagonal is 1 m.
  std::size_t maxExamined = 50;  ///< Ticks of each mode that are halved, those with the largest changes.
  std::uint64_t seed = 1;
  BenchClock clock = BenchClock::Thread;
};

/// Force of one mode at one tick.
struct ForceSample {
  std::string scene, mode;
  std::size_t tick;
  Wrench wrench;
  std::size_t springs;
};

/// One spring at the global minimum, springs at all pairs of triangles, at the minima of the paper's rule, at the exact
/// ones, by both laws, and at the nearest of each area of contact, and the proxy, along one path: that which the proxy's
/// part takes under a hand that presses it into the scene. @param samples  Gets every tick; may be null.
std::vector<PaperFigure> argumentFigures(const PaperRow& row, const BenchScene& meshes,
                                         const ArgumentOptions& options, std::vector<ForceSample>* samples);

}  // namespace nearfit::bench
