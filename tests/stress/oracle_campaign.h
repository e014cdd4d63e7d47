#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/exact/exact_judge.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/lmd_oracle.h"

/// Many poses of many pairs against brute force; where the two differ, or the engine says that it is
/// marginal, exact arithmetic decides.
namespace nearfit::stress {

struct OracleRange {
  std::uint64_t seed = 1;
  std::size_t first = 0;  ///< Number of the first pose of each pair.
  std::size_t count = 0;  ///< Poses of each pair.
};

struct OracleTally {
  std::size_t poses = 0;
  std::size_t found = 0;      ///< Minima and regions.
  std::size_t flagged = 0;    ///< Of them, marginal.
  std::size_t regions = 0;    ///< Of them, flat regions.
  std::size_t judged = 0;     ///< Poses that exact arithmetic looked at.
  std::size_t differing = 0;  ///< Of them, those at which brute force in double precision says otherwise.
  std::vector<std::string> faults;

  OracleTally& operator+=(const OracleTally& other);
};

/// One pair and what is made of it once. Poses depend on the seed, the pair's name and their number alone, so
/// that any can be run again.
class OraclePair {
 public:
  explicit OraclePair(const test::BodyPair& pair);

  /// Poses from `first` to before `end`.
  void run(std::uint64_t seed, std::size_t first, std::size_t end, OracleTally& tally) const;

 private:
  struct Case;
  void check(const Case& at, OracleTally& tally) const;
  double cutoffOf(const RigidTransform& pose, std::uint64_t choice) const;
  std::vector<Lmd> found(const RigidTransform& pose, double cutoff) const;
  std::vector<std::string> regionFaults(const std::vector<Lmd>& found, const RigidTransform& pose,
                                        double cutoff) const;
  bool agrees(const std::vector<Lmd>& found, const RigidTransform& pose, double cutoff) const;

  test::BodyPair pair_;
  NormalConeTree sceneTree_, partTree_;
  test::OracleBody scene_, part_;
  test::ExactJudge judge_;
  double cutoff_;
};

/// All pairs in turn, a block of poses of each, on so many threads.
/// @param onBlock  Called with what was done so far, by one thread at a time. May be empty.
OracleTally runOracleCampaign(const std::vector<test::BodyPair>& pairs, const OracleRange& range,
                              unsigned threads, const std::function<void(const OracleTally&)>& onBlock = {});

}  // namespace nearfit::stress
