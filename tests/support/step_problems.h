#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/haptics/step_program.h"

namespace nearfit::test {

/// A program of the proxy's step.
struct StepProblem {
  StepRows rows{StepRows::kDefaultCapacity};
  std::vector<glm::dvec3> arms;  ///< Of the rows, in principal axes [m].
  StepGoal goal;
};

/// Kinds of problems, each made from a seed and a number of rows; the same on every machine.
enum class StepProblemKind : std::uint8_t {
  Random,         ///< Directions, arms and distances without order.
  NearParallel,   ///< Clusters of directions that differ by 1e-12 to 1e-3 rad: conforming contact.
  Opposing,       ///< Pairs from two sides in gaps narrower than two margins, some of no width.
  Wedge,          ///< Two walls at a small angle that close towards the part.
  Duplicates,     ///< Each row many times, to the last bit.
  NoRotation,     ///< Arms along the directions.
  ExtremeScales,  ///< Bodies of micrometres to kilometres, slim ones, and goals far away.
  Ring,           ///< A peg in its bore: normals around an axis at two heights, all nearly at the margin.
  Floor,          ///< A box on a floor: one direction, a grid of arms.
};

inline constexpr StepProblemKind kStepProblemKinds[] = {
    StepProblemKind::Random,        StepProblemKind::NearParallel, StepProblemKind::Opposing,
    StepProblemKind::Wedge,         StepProblemKind::Duplicates,   StepProblemKind::NoRotation,
    StepProblemKind::ExtremeScales, StepProblemKind::Ring,         StepProblemKind::Floor};

std::string nameOf(StepProblemKind kind);

/// @param rows  0 to StepRows::kDefaultCapacity. The reach is infinite; bounds of motion are the caller's.
StepProblem makeStepProblem(StepProblemKind kind, std::uint64_t seed, std::size_t rows);

/// The lengths that a problem's numbers are of, for tolerances [m]: the goal, the margin, the least distance,
/// times the largest row.
double lengthOf(const StepProblem& problem);

}  // namespace nearfit::test
