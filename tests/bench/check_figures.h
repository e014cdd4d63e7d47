#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/check_run.h"

namespace nearfit::bench {

/// Goals for one scene; 0: none is set.
struct CheckGoals {
  double seconds = 0.0;    ///< Of the whole check by "nearfit", at most.
  double bytes = 0.0;      ///< Max resident memory then.
  double peerRatio = 0.0;  ///< Times as long that a peer takes, at least.
  /// Near pairs that the scene has to have, or no goal of its check is met.
  std::size_t nearPairs = 0;
};

/// One figure of a method on a scene, or of a report.
struct CheckFigure {
  std::string scene, method, name, unit;
  std::size_t parts = 0, meshes = 0, triangles = 0;  ///< Of the scene.
  double threshold = 0.0;                            ///< [m]
  std::size_t runs = 0;
  double median = 0.0;
  double worst = 0.0;  ///< The max, or the min of what is to be at least something.
  double goal = 0.0;   ///< 0: none is set.
  bool isAtLeast = false;
  bool isOfGoalSize = true;  ///< False if the scene has less in it than the goal is for.
  std::string remark;        ///< Without commas.

  /// True if the scene is what the goal is for, and the median meets it.
  bool isMet() const { return isOfGoalSize && (isAtLeast ? median >= goal : median <= goal); }
};

/// All figures of a scene. @param runs  Of runChecks(), of one turn or more.
std::vector<CheckFigure> checkFigures(const ManyPartsScene& scene, const CheckGoals& goals,
                                      const std::vector<CheckMethodRuns>& runs);

/// A figure of samples, one or more.
CheckFigure checkFigureOf(const ManyPartsScene& scene, std::string method, std::string name, std::string unit,
                          const std::vector<double>& samples);

std::string checkTableHeader();
std::string checkTableLine(const CheckFigure& figure);
std::string checkCsvHeader();
std::string checkCsvLine(const CheckFigure& figure);

/// Why figures are void, a sentence each: libraries that disagree.
std::vector<std::string> checkProblems(const ManyPartsScene& scene, const std::vector<CheckMethodRuns>& runs);

}  // namespace nearfit::bench
