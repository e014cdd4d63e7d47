#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/error_method.h"
#include "tests/bench/paper_figures.h"
#include "tests/exact/exact_oracle.h"

/// Answers judged by exact arithmetic: minima that a method misses, minima that are none, and what that does to the
/// sum of springs.
namespace nearfit::bench {

/// What is true at a pose.
struct JudgedPose {
  RigidTransform sceneFromPart;
  /// Minima that no rounding within what double precision resolves could take away, each place once.
  std::vector<Lmd> minima;
  /// Others that are minima, or nearly: whoever has them is not blamed, nor who has not.
  std::vector<test::ExactMinimum> closeCalls;
  Wrench wrench;  ///< Of the minima, as ErrorScene::wrenchOf.
  /// True where there are no close calls, so that the wrench is the only right one.
  bool isWrenchKnown() const noexcept { return closeCalls.empty(); }
};

/// Asks the oracle. Takes up to seconds.
JudgedPose judgedPose(const test::ExactOracle& oracle, const ErrorScene& scene,
                      const RigidTransform& sceneFromPart);

/// What is wrong with an answer.
struct Judgement {
  std::size_t missed = 0;    ///< True minima that it has not.
  std::size_t spurious = 0;  ///< That it has, and are none; a second one at the place of another counts.
  /// |F - F true| / |F true|, and the same of torque; none where the truth is not known, or zero.
  std::optional<double> force, torque;
};

/// @param size  Sum of the bodies' diagonals [m]: places agree to kSamePlaceShare of it.
Judgement judge(const ContactAnswer& answer, const JudgedPose& truth, double size);

/// Agreement of places, over the rounding of all methods, as a fraction of the size.
constexpr double kSamePlaceShare = 1e-9;

/// Judges methods at poses.
std::vector<PaperFigure> judgeFigures(const FigureHead& head, const ErrorScene& scene,
                                      std::span<const ErrorMethodEntry> methods,
                                      std::span<const RigidTransform> poses);

}  // namespace nearfit::bench
