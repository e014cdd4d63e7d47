#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/path/assembly_path.h"
#include "core/path/path_certifier.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Where a path should lead: to a pose, or out of the assembly.
struct PathGoal {
  /// worldFromLead; std::nullopt: where the box of what moves, along the axes of the world, is clear of the box of all
  /// other visible parts.
  std::optional<RigidTransform> pose;
};

/// Limits of a search.
struct PathSearchOptions {
  double separation = 0.0;  ///< To keep from all other visible parts [m]; 0: defaultSeparation().
  /// For search and shortening together; > 0. What is made of the parts before, where the cache does not have it, and the
  /// check of a motion that has begun come on top.
  double seconds = 30.0;
  std::uint64_t seed = 1;
  /// Motions that each thread of the search tries; the result depends on this limit and the seed alone if the time lasts.
  std::uint64_t maxMotions = std::numeric_limits<std::uint64_t>::max();
  bool mayTurn = true;  ///< False: what moves is only shifted.
  /// Tells the time since any moment [s], to several threads; empty: the system's steady clock.
  std::function<double()> now = {};
};

/// Max time of a search [s]: a day.
constexpr double kMaxSearchSeconds = 86'400.0;

enum class PathSearchEnd : std::uint8_t {
  Found,
  NotFound,      ///< Which does not mean that there is none.
  StartNotFree,  ///< A moving part starts nearer to another part than the separation, or meets it.
  GoalNotFree,   ///< The same at the goal.
};

/// Ways of finding a path, in the order in which they are tried.
enum class PathSearchMethod : std::uint8_t {
  Straight,       ///< In one straight motion.
  Sliding,        ///< Drawn one way, sliding along what is in the way.
  SlidingTrees,   ///< planBySliding()
  ConnectedTrees  ///< planByConnecting(): RRT-Connect.
};

/// Result of a search, and its effort.
struct PathSearchResult {
  PathSearchEnd end = PathSearchEnd::NotFound;
  double separation = 0.0;  ///< [m]
  AssemblyPath path;        ///< If it was found: from the pose in the scene to the goal, proven free.
  PathProof proof;          ///< Of the path.
  PathSearchMethod method = PathSearchMethod::Straight;  ///< That found it.
  std::optional<UnprovenPlace> blocked;                  ///< If start or goal is not free: by what.

  std::size_t directions = 0;  ///< In which it was drawn.
  std::size_t poses = 0;       ///< That the trees reached.
  std::uint64_t motions = 0;   ///< That the trees tried.
  /// How far it came: the greatest shift of the centre from the start; toward a pose, the least displacement that was
  /// left of any point [m].
  double farthest = 0.0, nearest = std::numeric_limits<double>::infinity();
  double seconds = 0.0;  ///< Taken in all [s].
};

/// Looks for a path of what the scene has in hand, from where it is, that keeps a separation from all other visible
/// parts; and proves it. What is in hand moves freely: joints do not hold it.
///
/// First straight motions are tried, then motions along which it probably comes apart (across what it touches, along its
/// axes), sliding along what is in the way; then two planners search poses at random, each in a thread. A path that is
/// found is shortened where shorter motions are proven free, in half of the time at most and in what is left of it. Takes
/// the start as it is: parts that touch have to be moved apart first, by the separation.
/// Throws UsageError if nothing is in hand, an option is not valid, it is at the goal already, or as PathCertifier;
/// Cancelled. May take seconds: not for the GUI thread.
PathSearchResult searchPath(const Scene& scene, const PathGoal& goal, const PathSearchOptions& options,
                            const ProgressCallback& progress = {});

/// Describes the result of a search in sentences for the user.
/// @param length  A length [m] with its unit.
std::string describePathSearch(const Scene& scene, const PathGoal& goal, const PathSearchResult& result,
                               const std::function<std::string(double)>& length);

}  // namespace nearfit
