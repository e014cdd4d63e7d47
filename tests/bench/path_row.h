#pragma once

#include <cstddef>
#include <string>

#include "tests/bench/proven_path.h"

namespace nearfit::bench {

/// How long a path takes to be certified and verified, and at how many random places on it parts meet.
struct PathRow {
  std::string scene;
  std::size_t poses = 0;
  std::size_t triangles = 0;           ///< Sum over the parts that move and the others.
  std::size_t moving = 0, others = 0;  ///< Parts that move, and parts that they may not meet.
  double certified = 0.0;              ///< Time to prove the path, hierarchies not counted [s].
  double verified = 0.0;               ///< Time to prove its certificate anew [s].
  /// Times of `nearfit-cli certify` and `verify` as processes, from files [s]; 0: not timed.
  double certifyProcess = 0.0, verifyProcess = 0.0;
  PlaceLooks looks = {};  ///< At random places.
  PlaceLooks plain = {};  ///< At as many, each by exact predicates; no places: not done.
  double goal = 0.0;      ///< Certified within this, verified within twice that [s]; 0: none is set.

  /// How many times as long it takes to verify as to certify.
  double ratio() const { return certified > 0.0 ? verified / certified : 0.0; }
  std::size_t meetings() const { return looks.meetings + plain.meetings; }
  /// Within the goal in this process and as processes, and without a meeting.
  bool isMet() const {
    return certified <= goal && verified <= 2.0 * goal && certifyProcess <= goal &&
           verifyProcess <= 2.0 * goal && meetings() == 0;
  }
  /// The other reading of "verified within twice that": twice the time that certifying this path took.
  bool isWithinTwice() const { return verified <= 2.0 * certified; }
};

std::string pathTableHeader();
std::string pathTableLine(const PathRow& row);
std::string pathCsvHeader();
std::string pathCsvLine(const PathRow& row);

}  // namespace nearfit::bench
