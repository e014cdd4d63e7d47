#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tests/bench/interleaved_run.h"

namespace nearfit::bench {

/// How the answers of a method compare with those of others at the same poses.
struct Agreement {
  /// Largest difference of the least distances [m]; infinity when one sees the bodies within the cutoff and
  /// the other clearly does not.
  double worstDistance = 0.0;
  std::size_t worstPose = 0;
  std::size_t touching = 0;         ///< Poses at which the reference says that the bodies touch.
  std::size_t incomplete = 0;       ///< Answers that say they are not complete.
  std::size_t differentCounts = 0;  ///< Poses with another number of minima, where both list all.
  bool holds = true;                ///< Whether the two answer the same question alike.
};

/// The first run that gives the least distance whatever it is, else the first run.
const MethodRun& referenceOf(std::span<const MethodRun> runs);

/// Compares each run with the reference;
/// methods that list all minima also with the first of their kind, in number.
/// @param cutoff, size  Of the scene [m]; where the reference is beyond the cutoff the other says nothing, or
///                      the same distance.
/// The runs compared with must hold all poses of the others.
std::vector<Agreement> compareRuns(std::span<const MethodRun> runs, double cutoff, double size);

}  // namespace nearfit::bench
