#pragma once

#include <cstddef>
#include <string>

namespace nearfit::bench {

/// How long a path takes to be certified and verified, and at how many random places on it parts meet.
struct PathRow {
  std::string scene;
  std::size_t poses = 0;
  std::size_t triangles = 0;  ///< Of all parts that are looked at.
  double certified = 0.0;     ///< Time to prove the path, hierarchies not counted [s].
  double verified = 0.0;      ///< Time to prove its certificate anew [s].
  std::size_t places = 0;     ///< Random places looked at by exact predicates.
  std::size_t meetings = 0;   ///< Thereof where parts meet; of several pairs of parts, the sum.
  double goal = 0.0;          ///< Certified within this, verified within twice that [s]; 0: none is set.

  /// How many times as long it takes to verify as to certify.
  double ratio() const { return certified > 0.0 ? verified / certified : 0.0; }
  bool isMet() const { return certified <= goal && verified <= 2.0 * goal && meetings == 0; }
};

std::string pathTableHeader();
std::string pathTableLine(const PathRow& row);
std::string pathCsvHeader();
std::string pathCsvLine(const PathRow& row);

}  // namespace nearfit::bench
