#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/verdict/scene_check.h"
#include "tests/bench/check_peer.h"
#include "tests/bench/many_parts.h"

namespace nearfit::bench {

/// Nearfit's check of a scene, and what it took.
struct OwnCheck {
  double buildSeconds = 0.0;  ///< Hierarchies from meshes in memory.
  double pairsSeconds = 0.0;  ///< All else: pairs, and what clashes are measured by.
  SceneCheck found;           ///< Parts have their index, plus one, as ID.
  /// Of the process, before it and at most since [bytes]. The peak is that since the process began where the system does
  /// not let it start anew: never too low.
  std::uint64_t residentBefore = 0, residentPeak = 0;

  double seconds() const { return buildSeconds + pairsSeconds; }
};

/// Builds all hierarchies anew and checks all pairs, on all processors.
/// @param measuresClashes  Else volumes and depths of clashes are left out.
OwnCheck measureOwnCheck(const ManyPartsScene& scene, bool measuresClashes);

/// How a library's answers compare with Nearfit's.
struct CheckAgreement {
  double worstDistance = 0.0;  ///< Largest difference of a least distance [m].
  std::size_t compared = 0;    ///< Pairs that both found.
  std::size_t missing = 0;     ///< Pairs that Nearfit alone found, though the library measured all.
  std::size_t extra = 0;       ///< Pairs that the library alone found.
  std::size_t apart = 0;       ///< Clashes here that are none there.
  bool holds = true;           ///< Distances agree to a billionth of the diagonal, and so do all pairs.
};

/// Compares least distances of near pairs, and clashes with collisions. A pair that is at the threshold to rounding may
/// have been found by one alone; of touching parts, distances up to touchTolerance() are equal. Contained parts are left
/// out: a library of surfaces does not know them.
CheckAgreement compareChecks(const SceneCheck& own, const PeerCheck& peer, const ManyPartsScene& scene);

/// What one method took in all turns.
struct CheckMethodRuns {
  std::string method;
  std::vector<double> build, pairs, whole;   ///< [s], by turn.
  std::vector<double> residentPeak;          ///< [bytes]; empty for a peer.
  double residentBefore = 0.0;               ///< Most of all turns [bytes].
  std::size_t candidates = 0, measured = 0;  ///< Of a peer: PeerCheck. In the turn that measured least.
  std::size_t near = 0, touching = 0, clashes = 0,
              contained = 0;              ///< Pairs; of a peer `near` are all within.
  std::size_t listed = 0, fullLists = 0;  ///< Of a peer: PeerCheck. In the same turn.
  CheckAgreement agreement;               ///< Of a peer: the worst of all turns.

  bool isCut() const { return measured < candidates; }
};

struct CheckRunOptions {
  std::size_t repeats = 3;
  double maxPeerSeconds = 120.0;  ///< For the pairs of a library; cut beyond.
};

/// Runs "nearfit", "nearfit-unmeasured" and the peers, in turns.
std::vector<CheckMethodRuns> runChecks(const ManyPartsScene& scene, const std::vector<CheckPeer>& peers,
                                       const CheckRunOptions& options);

}  // namespace nearfit::bench
