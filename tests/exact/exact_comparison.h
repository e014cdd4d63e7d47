#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/exact/exact_judge.h"
#include "tests/support/lmd_comparison.h"

/// Comparison of the engine's sets with those of exact arithmetic; differences are reported to GoogleTest.
namespace nearfit::test {

/// Two bodies, both hierarchies, and the oracle.
class ExactComparison {
 public:
  explicit ExactComparison(const BodyPair& pair);

  /// Holds what findLmds gives at a pose against the promise: each exact minimum is there, those that are no
  /// marginal ones once; each found one is an exact minimum to within tolerance. The same with the bodies
  /// swapped, with each instruction set, and from a candidate list built elsewhere within its budget.
  void checkPose(const RigidTransform& pose, double cutoff);

  /// Poses near contact: at random, with the axes of both bodies aligned, and aimed at close calls.
  /// @param cutoffFraction  Of the larger body's diagonal.
  void checkPoses(std::size_t poses, double cutoffFraction, std::uint64_t seed);

  const ExactTally& tally() const { return tally_; }
  double size() const { return judge_.size(); }

 private:
  void checkSet(const std::vector<Lmd>& found, const std::vector<ExactMinimum>& exact, double cutoff,
                const std::string& where);
  void checkVariants(const RigidTransform& pose, double cutoff, const std::vector<Lmd>& found);
  const BodyPair& pair_;
  NormalConeTree scene_, part_;
  ExactJudge judge_;
  ExactTally tally_;
};

}  // namespace nearfit::test
