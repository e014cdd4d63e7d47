#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/proximity/lmd.h"
#include "tests/exact/exact_oracle.h"
#include "tests/support/lmd_comparison.h"

/// What the engine found at a pose, held against exact rational arithmetic on the very doubles of the meshes
/// and the pose (whose rotation is that of its quaternion divided by its length: rational, as it is
/// quadratic).
namespace nearfit::test {

std::string describe(const Lmd& lmd);
/// In full precision.
std::string describe(const RigidTransform& pose);

/// Counts of a comparison, so that a test can ask that it compared anything.
struct ExactTally {
  std::size_t poses = 0;
  std::size_t minima = 0;    ///< That rounding within the promise cannot add or take away.
  std::size_t marginal = 0;  ///< Others that exact arithmetic finds: there are, but only just.
  std::size_t found = 0;
  std::size_t flagged = 0;  ///< Of those found: said to be marginal.
};

class ExactJudge {
 public:
  explicit ExactJudge(const BodyPair& pair);

  /// All that is a minimum, or is none by little.
  std::vector<ExactMinimum> minimaAt(const RigidTransform& pose, double cutoff) const;

  /// What is wrong with what was found, a line each:
  /// - an exact minimum is missing; it may be at a neighbour's place only where it is a close call, and
  ///   the neighbour is then marginal or a region;
  /// - one is there that exact arithmetic has none for, not even to the resolution promised; or none but to
  ///   that, and it does not say that it is marginal;
  /// - one says that it is marginal, and exact arithmetic sees nothing that is nearly otherwise;
  /// - one is there twice, or in itself inconsistent.
  std::vector<std::string> faults(const std::vector<Lmd>& found, const std::vector<ExactMinimum>& exact,
                                  double cutoff, ExactTally& tally) const;

  double size() const { return oracle_.size(); }

 private:
  double pointTolerance(const Lmd& f) const;
  bool isAt(const Lmd& f, const ExactMinimum& e) const;
  bool isWithin(const Lmd& f, const ExactMinimum& e) const;
  bool isSameContact(const Lmd& f, const ExactMinimum& e) const;
  bool standsFor(const Lmd& f, const ExactMinimum& e, bool isCertain) const;
  bool isMissing(const ExactMinimum& e, const std::vector<Lmd>& found, bool isCertain) const;
  std::string faultOf(const Lmd& f, const std::vector<ExactMinimum>& exact, double cutoff) const;
  bool isRightlyMarginal(const Lmd& f, const std::vector<const ExactMinimum*>& at, double cutoff) const;

  ExactOracle oracle_;
  double centres_;  ///< Of both meshes from their origins [m].
};

}  // namespace nearfit::test
