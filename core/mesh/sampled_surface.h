#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/math/aabb.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A mesh cut into triangles with short sides, for values that vary over its surface. In the mesh's frame. Samples are
/// its vertices, split along sharp edges as for drawing, and points on its triangles.
struct SampledSurface {
  std::vector<glm::dvec3> points;   ///< [m]
  std::vector<glm::vec3> normals;   ///< As the mesh is shaded: of length 1, or 0 where it has none.
  std::vector<Triangle> triangles;  ///< Of the surface, triangle by triangle of the mesh.
  std::vector<std::uint32_t>
      firstOf;                ///< Triangle i of the mesh has those from firstOf[i] to before firstOf[i + 1].
  std::vector<double> areas;  ///< Share of each sample in the surface: a third of its triangles [m^2].
  double maxSide = 0.0;       ///< No side near is longer [m]; see Sampling.
  bool isCoarse = false;      ///< maxSide is longer than asked for, to keep within the max number of samples.
};

/// How finely a surface is sampled.
struct Sampling {
  double maxSide = 0.0;        ///< Max length of a side [m]; finite, > 0.
  std::size_t maxSamples = 0;  ///< Of the surface; the vertices of the mesh are always samples.
  /// Where samples matter, in the mesh's frame: away from it, sides may be longer by a quarter of the distance of their
  /// middle. Nullopt: everywhere.
  std::optional<Aabb> near;
};

/// Samples a mesh. A side is halved until it is short; triangles that share it take the same points, so that there
/// are no gaps. If there would be more samples than the max, sides may be longer, everywhere alike. O(samples).
/// Throws Cancelled.
SampledSurface sampleSurface(const TriangleMesh& mesh, const Sampling& sampling,
                             const ProgressCallback& progress = {});

}  // namespace nearfit
