#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/path/assembly_path.h"
#include "core/path/path_bodies.h"
#include "core/scene/scene.h"

namespace nearfit::bench {

/// Outcome of certifying a path and verifying its certificate.
struct PathProofCheck {
  bool isCertified = false, isVerified = false;
  double certifySeconds = 0.0;  ///< Time to prove the path, hierarchies not counted [s].
  double verifySeconds = 0.0;   ///< Time to prove its certificate anew [s].
  std::string problem = {};     ///< Why it is not certified or not verified.
};

/// Proves a path anew, writes its certificate as text, reads that, and lets the verifier prove it.
/// @param separation  To keep from all other visible parts [m].
PathProofCheck proveAndVerify(const Scene& scene, const AssemblyPath& path, double separation);

/// Looks at random places of a path by exact predicates, for each pair of a moving part and another. All counts but the
/// places are sums over the pairs.
struct PlaceLooks {
  std::size_t places = 0;
  std::size_t looks = 0;     ///< Places times pairs.
  std::size_t tested = 0;    ///< Decided by exact predicates on the triangles (WayVerdicts).
  std::size_t measured = 0;  ///< Decided by the gap between the triangles, at the place itself.
  std::size_t boxed = 0;     ///< Decided by boxes that are apart.
  std::size_t meetings = 0;
  std::string firstMeeting = {};  ///< Names of a pair that meets.

  /// Looks that were argued from a gap found at a place before.
  std::size_t argued() const { return looks - tested - measured - boxed; }
};

/// Random places on a path, looked at in order.
PlaceLooks lookAtPlaces(const AssemblyPath& path, const nearfit::PathBodies& bodies, std::size_t places,
                        std::uint64_t seed);

/// The same with PoseCertifier::doMeet() at each place: nothing is argued from another place.
PlaceLooks testPlaces(const AssemblyPath& path, const nearfit::PathBodies& bodies, std::size_t places,
                      std::uint64_t seed);

}  // namespace nearfit::bench
