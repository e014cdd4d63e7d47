#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "tests/bench/analytic_contacts.h"

namespace nearfit::bench {

/// What tessellation does to a pair of solids, and so how its error falls with the edge length.
enum class PairKind {
  Smooth,  ///< Curved surfaces: the distance's error with its square, position and direction with itself.
  Exact,   ///< The meshes are the solids: rounding alone.
};

/// Two solids of which all local minimum distances are known.
struct ErrorPair {
  std::string name, description;
  PairKind kind = PairKind::Smooth;
  double cutoff = 0.25;  ///< [m]
  /// Meshes by fineness: see error_shapes.h.
  std::function<TriangleMesh(std::uint32_t)> scene{}, part{};
  /// Whether the scene is meshed finer too; a floor is always of twelve triangles.
  bool isSceneCurved = false;
  /// Facets tell a gap's first derivatives, not its second ones: near a saddle of the distance, meshes may
  /// have a minimum however fine they are, where the solids have none. Whether there are such within the
  /// cutoff.
  bool hasSaddles = false;
  /// All, at any distance; a distance that is not positive says that the solids meet.
  std::function<std::vector<TrueContact>(const RigidTransform& sceneFromPart)> contacts{};
  /// A pose that may do.
  std::function<RigidTransform(std::mt19937_64&)> proposePose{};
};

/// A pose and what is true there, within the cutoff.
struct ErrorPose {
  RigidTransform sceneFromPart;
  std::vector<TrueContact> contacts{};
};

std::vector<ErrorPair> errorPairs();

/// Random poses of a pair; the same for the same seed, whatever the meshes. Each has a minimum between 0.35
/// and 0.85 of the cutoff and none nearer, none between 0.85 and 1.25 of it (a coarse mesh may have it on
/// either side), and none that hardly is one: kMaxSpread. Throws Error when proposals do not do.
std::vector<ErrorPose> randomPoses(const ErrorPair& pair, std::size_t count, std::uint64_t seed);

/// Of a pose's minima: beyond this their place is lost in a coarse tessellation.
inline constexpr double kMaxSpread = 12.0;

}  // namespace nearfit::bench
