#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace nearfit::bench {

/// Searches of the path of one puzzle, with one seed after another.
struct SuggestRow {
  std::string scene;
  double limit = 30.0;               ///< Time in which a path is to be found [s].
  double share = 0.9;                ///< Share of the seeds that are to find one.
  std::size_t found = 0;             ///< Number of seeds that found one within the limit.
  std::vector<double> seconds = {};  ///< By seed, however the search ended [s].

  /// Counts a search; one that found its path after the limit counts as one that did not.
  void add(bool isFound, double time);
  std::size_t seeds() const { return seconds.size(); }
  /// Least number of seeds that are to find a path.
  std::size_t wanted() const;
  bool isMet() const { return found >= wanted(); }
  /// Of the times of all seeds, one or more [s].
  double median() const;
  double max() const;
};

std::string suggestCsvHeader();
std::string suggestCsvLine(const SuggestRow& row);

}  // namespace nearfit::bench
