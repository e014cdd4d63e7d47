#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/scene/scene.h"

namespace nearfit::bench {

/// Size and seed of a generated scene of many parts.
struct ManyPartsSize {
  std::size_t parts = 200;
  std::size_t shapes = 20;  ///< Different meshes, shown in turn.
  /// Shapes have 20 * frequency^2 and 20 * (frequency + 1)^2 triangles in turn.
  std::uint32_t frequency = 22;
  std::size_t clashEvery = 40;      ///< Each so many-th part is moved into the one before it; 0: none is.
  double thresholdFraction = 0.01;  ///< Of the scene's diagonal.
  std::uint64_t seed = 1;           ///< Of the rotations; shapes have seeds of their own.
};

/// A mesh where it is placed.
struct ManyPartsPlace {
  std::uint32_t mesh = 0;  ///< Index.
  RigidTransform worldFromPart;
};

/// Parts to be checked with each other, as meshes alone: what every library starts from.
struct ManyPartsScene {
  std::string name;
  std::vector<TriangleMesh> meshes;  ///< All different.
  std::vector<ManyPartsPlace> parts;
  double diagonal = 0.0, threshold = 0.0;  ///< [m]
  /// Pairs that were moved into each other, by index, the lower one first. Others may clash with these too.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> meantClashes;

  /// Number of triangles of all parts.
  std::size_t triangles() const;
  const TriangleMesh& meshOf(std::size_t part) const { return meshes[parts[part].mesh]; }
};

/// Lumpy bodies (organicMesh()), each turned at random and stacked on those before it, a gap of about a hundredth of its
/// size between their boxes in the world. Their boxes in each other's frames overlap, as those of neighbours in an
/// assembly do, and no two pairs are alike.
ManyPartsScene stackedParts(const std::string& name, const ManyPartsSize& size);

/// Size and seed of a generated scene of parts that fit.
struct FittedPartsSize {
  std::size_t pegs = 100;           ///< Half as many as parts.
  std::uint32_t fineness = 4;       ///< Each triangle is cut in four so many times: blocks of 32, pegs of 16.
  double thresholdFraction = 0.01;  ///< Of the scene's diagonal.
  std::uint64_t seed = 1;           ///< Of how far each is off its place.
};

/// Straight channels along x between the pegs of fittedParts() and between its layers of blocks: their middle lines. In
/// each there is room for a ball of radius 0.75.
struct ChannelGrid {
  glm::dvec3 first{0.0};  ///< Where the first channel begins [m].
  double length = 0.0;
  double pitch = 0.0, rise = 0.0;  ///< From one channel to the next, along y and along z [m].
  std::size_t rows = 0, layers = 0;
};
ChannelGrid channelsOf(const FittedPartsSize& size);

/// Square pegs in the holes of blocks, side by side and on each other with small gaps, none of which quite alike: flat
/// walls that face each other, cut finely, as machine parts have them. Nothing meets.
ManyPartsScene fittedParts(const std::string& name, const FittedPartsSize& size);

/// The visible parts of a scene that have triangles.
ManyPartsScene manyPartsOf(const std::string& name, const Scene& scene, double thresholdFraction);

}  // namespace nearfit::bench
