#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/many_parts.h"

namespace nearfit::bench {

/// Two parts by their indices.
using PeerIndices = std::pair<std::uint32_t, std::uint32_t>;

/// A pair of parts that a library found within the threshold.
struct PeerPair {
  std::uint32_t part = 0, other = 0;  ///< Indices, the lower one first.
  double distance = 0.0;              ///< Least distance of the surfaces [m].
  bool doMeet = false;  ///< The library's own test of collision; not asked of pairs that are apart.
};

/// A library's check of a scene: of each pair that its broad phase finds, the least distance if it is within the
/// threshold; where the library can list them, also all pairs of triangles that are. Pairs of parts are shared out to
/// the threads that a check of Nearfit has.
struct PeerCheck {
  double buildSeconds = 0.0;   ///< Hierarchies from meshes in memory, each mesh once.
  double pairsSeconds = 0.0;   ///< Broad phase and distances.
  std::size_t candidates = 0;  ///< Pairs that the broad phase finds.
  std::size_t measured = 0;    ///< Thereof within the limit of time.
  std::vector<PeerPair> near;  ///< Of those measured, in ascending order.
  std::size_t listed = 0;      ///< Pairs of triangles within the threshold; 0 where none are asked for.
  std::size_t fullLists = 0;   ///< Lists that ended because they were full.

  double seconds() const { return buildSeconds + pairsSeconds; }
  bool isCut() const { return measured < candidates; }
};

struct CheckPeer {
  std::string name;
  /// Measures no further pairs once those have taken `maxSeconds`.
  std::function<PeerCheck(const ManyPartsScene& scene, double maxSeconds)> check;
};

CheckPeer fclCheckPeer();   ///< Where the program is built with FCL.
CheckPeer coalCheckPeer();  ///< Where the program is built with Coal.
/// The same with a list of all pairs of triangles within the threshold: among them are those of all minima, which its
/// caller would still have to find.
CheckPeer coalListsPeer();

/// All that this program is built with.
std::vector<CheckPeer> checkPeers();

}  // namespace nearfit::bench
