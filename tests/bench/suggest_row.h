#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/path/path_search.h"
#include "tests/bench/proven_path.h"

namespace nearfit::bench {

/// One search: what it says of itself, and what the certifier, the verifier and exact predicates say of its path.
struct SuggestedPath {
  bool isSaidFound = false;
  double seconds = 0.0;  ///< Time of the search, however it ended [s].
  PathSearchMethod method = PathSearchMethod::Straight;
  PathProofCheck proof = {};  ///< For a path that is said to be found, like `looks`.
  PlaceLooks looks = {};

  /// True if the path is certified, its certificate is verified, and no place on it meets anything.
  bool isConfirmed() const {
    return isSaidFound && proof.isCertified && proof.isVerified && looks.places > 0 && looks.meetings == 0;
  }
};

/// Searches of the path of one puzzle, with one seed after another.
struct SuggestRow {
  std::string scene;
  double limit = 30.0;                      ///< Time in which a path is to be found [s].
  double share = 0.9;                       ///< Share of the seeds that are to find one.
  std::size_t found = 0;                    ///< Seeds whose path is confirmed and was found within the limit.
  std::size_t said = 0;                     ///< Paths that the search says it has found, late or not.
  std::size_t certified = 0, verified = 0;  ///< Thereof.
  std::size_t free = 0;                     ///< Thereof those on which no place meets anything.
  std::size_t places = 0;                   ///< Random places looked at on each path.
  std::size_t tested = 0;                   ///< On all paths, each by exact predicates.
  std::size_t meetings = 0;                 ///< On all paths.
  std::array<std::size_t, 4> methods{};     ///< Paths by PathSearchMethod.
  std::vector<double> seconds = {};         ///< Time of each seed, however the search ended [s].

  void add(const SuggestedPath& path);
  std::size_t seeds() const { return seconds.size(); }
  /// Least number of seeds that are to find a path.
  std::size_t wanted() const;
  /// A path that is not confirmed misses the goal, however many others are.
  bool isMet() const { return found >= wanted() && free == said && verified == said; }
  /// Of the times of all seeds, one or more [s].
  double median() const;
  double max() const;
};

const char* wordOf(PathSearchMethod method);

std::string suggestCsvHeader();
std::string suggestCsvLine(const SuggestRow& row);

}  // namespace nearfit::bench
