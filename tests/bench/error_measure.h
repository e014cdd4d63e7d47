#pragma once

#include <cstddef>
#include <span>

#include "tests/bench/error_method.h"
#include "tests/bench/error_pairs.h"

namespace nearfit::bench {

/// What is wrong with an answer at one pose. A method's minimum belongs to the true one that is nearest to
/// it, while it is within matchBound of it. Where several belong to one, its errors are those of the least
/// distance, and the others are counted as extra: each of them is one more spring.
struct AnswerErrors {
  std::size_t missed = 0;    ///< True minima to which none belongs.
  std::size_t spurious = 0;  ///< That belong to none.
  std::size_t extra = 0;     ///< Beyond the first that belong to one, as facets have them.
  std::size_t matched = 0;   ///< True minima to which one belongs; without any the next three say nothing.
  double distance = 0.0;     ///< [m]
  double position = 0.0;     ///< Of the scene's or the part's point, whichever is farther off [m].
  double direction = 0.0;    ///< Length of the difference of the unit vectors [rad].
  double force = 0.0;        ///< [N], of springs that push with 1 N when they are pressed all the way.
  double torque = 0.0;       ///< About the part's origin [N m].
};

/// How far from the truth points may be, both of the scene and of the part [m]: twice what facets explain
/// (see contactSpread, which bounds the scene's point), and within a flat region anywhere in it.
double matchBound(const TrueContact& contact, double edge);

/// @param edge  The longest of the tessellations' [m].
AnswerErrors errorsOf(const ContactAnswer& answer, const ErrorPose& pose, const SpringParameters& springs,
                      double edge);

}  // namespace nearfit::bench
