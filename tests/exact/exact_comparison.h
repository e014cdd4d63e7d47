#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/exact/exact_oracle.h"
#include "tests/support/lmd_comparison.h"

/// Comparison of the engine's sets with those of exact arithmetic; differences are reported to GoogleTest.
namespace nearfit::test {

/// Counts of a comparison, so that a test can ask that it compared anything.
struct ExactTally {
  std::size_t poses = 0;
  std::size_t minima = 0;    ///< That rounding within the promise cannot add or take away.
  std::size_t marginal = 0;  ///< Others that exact arithmetic finds: there are, but only just.
  std::size_t found = 0;
};

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
  double size() const { return oracle_.size(); }

 private:
  void checkSet(const std::vector<Lmd>& found, const std::vector<ExactMinimum>& exact, double cutoff,
                const std::string& where);
  void checkVariants(const RigidTransform& pose, double cutoff, const std::vector<Lmd>& found);
  double pointTolerance(const Lmd& f) const;
  bool isAt(const Lmd& f, const ExactMinimum& e) const;
  bool isWithin(const Lmd& f, const ExactMinimum& e) const;
  bool isSameContact(const Lmd& f, const ExactMinimum& e) const;

  const BodyPair& pair_;
  NormalConeTree scene_, part_;
  ExactOracle oracle_;
  ExactTally tally_;
};

}  // namespace nearfit::test
