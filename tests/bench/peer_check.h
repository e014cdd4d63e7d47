#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel/parallel_for.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/check_peer.h"

namespace nearfit::bench {

/// Makes a library's hierarchy of each mesh, on all processors. @tparam Make  Maps a mesh to a pointer.
template <class Make>
auto peerModels(std::span<const TriangleMesh> meshes, const Make& make) {
  std::vector<decltype(make(meshes[0]))> models(meshes.size());
  parallelFor(meshes.size(), [&](std::size_t i) { models[i] = make(meshes[i]); });
  return models;
}

/// Measures a library.
/// @tparam Bodies  Constructed of a ManyPartsScene and what makeModels() of its meshes returns. Of two parts by their
///                 indices it has pairsWithin(threshold); distance(pair, within), in several threads, no less than
///                 `within` where nothing is nearer; doMeet(pair); and it may have addCounts(PeerCheck&).
template <class Bodies>
PeerCheck measurePeer(const ManyPartsScene& scene, double maxSeconds) {
  /// Distance at which the library is asked if the surfaces meet, of the scene's diagonal: far more than its rounding.
  constexpr double kAsked = 1e-6;
  PeerCheck check;
  const double start = secondsBy(BenchClock::Wall);
  const auto models = Bodies::makeModels(scene.meshes);
  const double built = secondsBy(BenchClock::Wall);
  const Bodies bodies(scene, models);
  const std::vector<PeerIndices> pairs = bodies.pairsWithin(scene.threshold);
  std::vector<double> distances(pairs.size(), std::numeric_limits<double>::quiet_NaN());
  std::atomic<std::size_t> measured{0};
  parallelFor(pairs.size(), [&](std::size_t i) {
    if (secondsBy(BenchClock::Wall) - built > maxSeconds) return;
    distances[i] = bodies.distance(pairs[i], scene.threshold);
    ++measured;
  });
  const double end = secondsBy(BenchClock::Wall);
  check.buildSeconds = built - start;
  check.pairsSeconds = end - built;
  check.candidates = pairs.size();
  check.measured = measured;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    // Of what was not measured it is NaN.
    if (!(distances[i] < scene.threshold)) continue;
    const bool isAsked = distances[i] <= kAsked * scene.diagonal;
    const auto [least, greatest] = std::minmax(pairs[i].first, pairs[i].second);
    check.near.push_back({least, greatest, distances[i], isAsked && bodies.doMeet(pairs[i])});
  }
  if constexpr (requires { bodies.addCounts(check); }) bodies.addCounts(check);
  std::ranges::sort(check.near, {}, [](const PeerPair& p) { return std::pair(p.part, p.other); });
  return check;
}

}  // namespace nearfit::bench
